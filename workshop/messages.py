"""Build messages that PyPI does not have: python workshop/messages.py, once for an environment.

The tests get their ROS 2 from PyPI, where tf2_msgs and simulation_interfaces are missing. What
`test/interfaces/PACKAGE` lists, fields and types only, is generated and compiled with the
generators, headers and libraries of the wheels. The folder messages/PACKAGE of the environment then
has the Python package, and its lib the libraries, for PYTHONPATH and LD_LIBRARY_PATH. A folder
PACKAGE-VERSION has what is different in another version, which is built too.
"""

import importlib
import os
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
from rosidl_adapter.action import convert_action_to_idl
from rosidl_adapter.msg import convert_msg_to_idl
from rosidl_adapter.srv import convert_srv_to_idl

PREFIX = Path(sys.prefix)
INTERFACES = Path(__file__).parents[1] / "test" / "interfaces"
BUILT = PREFIX / "messages"
CONVERTERS = {"msg": convert_msg_to_idl, "srv": convert_srv_to_idl, "action": convert_action_to_idl}
# Packages whose types the interfaces use, and their libraries.
USED = (
    "action_msgs",
    "builtin_interfaces",
    "geometry_msgs",
    "service_msgs",
    "std_msgs",
    "unique_identifier_msgs",
)
GENERATORS = (
    ("rosidl_generator_c", "GenerateC", "c"),
    ("rosidl_generator_py", "GeneratePython", "py"),
    ("rosidl_typesupport_introspection_c", "GenerateIntrospectionCTypesupport", "introspection_c"),
    ("rosidl_typesupport_fastrtps_c", "GenerateFastRTPSCTypesupport", "fastrtps_c"),
    ("rosidl_typesupport_c", "GenerateCTypesupport", "c"),
)
KINDS = ("typesupport_c", "typesupport_fastrtps_c", "typesupport_introspection_c")
SUFFIX = sysconfig.get_config_var("EXT_SUFFIX")


def main() -> int:
    """Build all packages."""
    if not (shutil.which("gcc") and shutil.which("g++")):
        print("no gcc and g++: tests of messages that PyPI does not have are left out")
        return 0
    shutil.rmtree(BUILT, ignore_errors=True)
    for source in INTERFACES.iterdir():
        build(source.name, BUILT / source.name)
    return 0


def list_interfaces(name: str) -> dict[Path, Path]:
    """Return the folder of each interface of a package, or of PACKAGE-VERSION, by its name."""
    folders = dict.fromkeys([INTERFACES / name.partition("-")[0], INTERFACES / name])
    return {path.relative_to(folder): folder for folder in folders for path in folder.glob("*/*.*")}


def build(name: str, folder: Path) -> None:
    """Generate the sources and compile them."""
    os.environ["AMENT_PREFIX_PATH"] = str(PREFIX)
    (folder / "lib").mkdir(parents=True)
    package = name.partition("-")[0]
    files = [f"{folder / 'idl'}:{each}" for each in convert(name, folder / "idl")]
    for module, generator, kind in GENERATORS:
        getattr(importlib.import_module(f"{module}.cli"), generator)(kind).generate(
            package_name=package,
            interface_files=files,
            include_paths=[str(PREFIX / "share")],
            # some generators give their files the same names
            output_path=folder / (module if kind == "introspection_c" else "") / package,
        )
    (folder / package / "__init__.py").touch()
    # each needs those before it
    needed: list[str] = []
    for library, sources in list_libraries(package, folder).items():
        target = folder / "lib" / f"lib{package}__rosidl_{library}.so"
        compile_library(folder, target, sources, needed)
        needed.append(f"{package}__rosidl_{library}")
    for kind in KINDS:
        target = folder / package / f"{package}_s__rosidl_{kind}{SUFFIX}"
        source = folder / package / f"_{package}_s.ep.rosidl_{kind}.c"
        compile_library(folder, target, [source], needed)


def convert(name: str, folder: Path) -> Iterator[Path]:
    """Write the IDL of every interface; yield its path in the folder."""
    for path, source in sorted(list_interfaces(name).items()):
        kind = path.parent.name
        (folder / kind).mkdir(parents=True, exist_ok=True)
        CONVERTERS[kind](source, name.partition("-")[0], path, folder / kind)
        yield path.with_suffix(".idl")


def list_libraries(package: str, folder: Path) -> dict[str, list[Path]]:
    """Return the sources of each library, by the last part of its name."""
    own = folder / package
    other = folder / "rosidl_typesupport_introspection_c" / package
    sources = {
        "generator_c": own.glob("*/detail/*__[dft]*.c"),  # description, functions, type_support
        "typesupport_introspection_c": other.glob("*/detail/*__type_support.c"),
        "typesupport_fastrtps_c": own.glob("*/detail/*__type_support_c.cpp"),
        "typesupport_c": own.glob("*/*__type_support.cpp"),
        "generator_py": own.glob("*/_*_s.c"),
    }
    return {name: list(files) for name, files in sources.items()}


def compile_library(folder: Path, target: Path, sources: list[Path], needed: list[str]) -> None:
    """Compile sources into a shared library that finds those it needs."""
    headers = [each for each in (PREFIX / "include").iterdir() if each.is_dir()]
    include = [
        folder,
        folder / "rosidl_typesupport_introspection_c",
        PREFIX / "include",
        *headers,
        sysconfig.get_paths()["include"],
        np.get_include(),
    ]

    def compile_file(source: Path) -> Path:
        compiler = "g++" if source.suffix == ".cpp" else "gcc"
        options = [f"-I{each}" for each in include]
        goal = source.with_suffix(f"{source.suffix}.{target.stem}.o")
        subprocess.run(
            [compiler, "-c", "-O0", "-fPIC", "-w", "-o", goal, source, *options], check=True
        )
        return goal

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        objects = list(pool.map(compile_file, sources))
    places = [folder / "lib", PREFIX / "lib"]
    installed = [
        path.name[3:-3] for each in USED for path in (PREFIX / "lib").glob(f"lib{each}__*")
    ]
    shared = ["g++", "-shared", "-o", str(target), f"-Wl,-soname,{target.name}"]
    subprocess.run(
        [
            *shared,
            *map(str, objects),
            *(f"-L{each}" for each in places),
            *(f"-Wl,-rpath,{each}" for each in places),
            *(f"-l{each}" for each in (*needed, *installed, "rosidl_runtime_c", "rcutils")),
            "-lfastcdr",
            "-lrosidl_typesupport_fastrtps_c",
            "-lrosidl_typesupport_fastrtps_cpp",
            "-lrosidl_typesupport_c",
            "-lrosidl_typesupport_introspection_c",
            "-lrmw",
        ],
        check=True,
    )


if __name__ == "__main__":
    sys.exit(main())
