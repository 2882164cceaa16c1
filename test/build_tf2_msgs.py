"""Build tf2_msgs/msg/TFMessage into a folder: python test/build_tf2_msgs.py FOLDER.

tf2_msgs is not on PyPI, where the tests get their ROS 2. Its message for /tf is generated and
compiled with the generators, headers and libraries of the wheels, in a few seconds. FOLDER then has
the Python package, and FOLDER/lib its libraries, for PYTHONPATH and LD_LIBRARY_PATH.
"""

from __future__ import annotations

import importlib
import os
import subprocess
import sys
import sysconfig
from pathlib import Path

import numpy as np

PREFIX = Path(sys.prefix)
MESSAGE = """\
module tf2_msgs { module msg { struct TFMessage {
  sequence<geometry_msgs::msg::TransformStamped> transforms;
}; }; };
"""
INCLUDE = '#include "geometry_msgs/msg/TransformStamped.idl"\n'
GENERATORS = (
    ("rosidl_generator_c", "GenerateC", "c"),
    ("rosidl_generator_py", "GeneratePython", "py"),
    ("rosidl_typesupport_introspection_c", "GenerateIntrospectionCTypesupport", "introspection_c"),
    ("rosidl_typesupport_fastrtps_c", "GenerateFastRTPSCTypesupport", "fastrtps_c"),
    ("rosidl_typesupport_c", "GenerateCTypesupport", "c"),
)
NAME = "tf2_msgs__rosidl_"
GEOMETRY = "geometry_msgs__rosidl_"
# Each library: the last part of its name, compiler, sources, and the libraries it needs.
LIBRARIES = (
    (
        "generator_c",
        "gcc",
        ("detail/tf_message__functions.c", "detail/tf_message__description.c"),
        (f"{GEOMETRY}generator_c", "rosidl_runtime_c", "rcutils"),
    ),
    (
        "typesupport_introspection_c",
        "gcc",
        ("detail/tf_message__type_support.c",),
        (f"{NAME}generator_c", f"{GEOMETRY}typesupport_introspection_c"),
    ),
    (
        "typesupport_fastrtps_c",
        "g++",
        ("detail/tf_message__type_support_c.cpp",),
        (
            *(f"{NAME}generator_c", f"{GEOMETRY}typesupport_fastrtps_c", "fastcdr"),
            *("rosidl_typesupport_fastrtps_c", "rosidl_typesupport_fastrtps_cpp"),
        ),
    ),
    (
        "typesupport_c",
        "g++",
        ("tf_message__type_support.cpp",),
        (f"{NAME}generator_c", "rosidl_typesupport_c"),
    ),
    (
        "generator_py",
        "gcc",
        ("_tf_message_s.c",),
        (f"{NAME}generator_c", f"{GEOMETRY}generator_py"),
    ),
)
EXTENSIONS = ("typesupport_c", "typesupport_fastrtps_c", "typesupport_introspection_c")


def build(folder: Path) -> None:
    """Generate the sources and compile them."""
    os.environ["AMENT_PREFIX_PATH"] = str(PREFIX)
    package, lib = folder / "tf2_msgs", folder / "lib"
    (folder / "idl" / "msg").mkdir(parents=True)
    lib.mkdir()
    (folder / "idl" / "msg" / "TFMessage.idl").write_text(INCLUDE + MESSAGE)
    for module, name, kind in GENERATORS:
        getattr(importlib.import_module(f"{module}.cli"), name)(kind).generate(
            package_name="tf2_msgs",
            interface_files=[f"{folder / 'idl'}:msg/TFMessage.idl"],
            include_paths=[str(PREFIX / "share")],
            output_path=package,
        )
    (package / "__init__.py").touch()
    for name, compiler, sources, needed in LIBRARIES:
        files = [package / "msg" / source for source in sources]
        compile_library(folder, compiler, lib / f"lib{NAME}{name}.so", files, needed)
    suffix = sysconfig.get_config_var("EXT_SUFFIX")
    for name in EXTENSIONS:
        needed = [
            f"{NAME}{each}" for each in (name, "generator_py", "generator_c", "typesupport_c")
        ]
        target = package / f"tf2_msgs_s__rosidl_{name}{suffix}"
        source = package / f"_tf2_msgs_s.ep.rosidl_{name}.c"
        compile_library(folder, "gcc", target, [source], needed)


def compile_library(folder, compiler, target, sources, needed):
    """Compile sources into a shared library that finds those it needs."""
    headers = [each for each in (PREFIX / "include").iterdir() if each.is_dir()]
    include = [
        folder,
        PREFIX / "include",
        *headers,
        sysconfig.get_paths()["include"],
        np.get_include(),
    ]
    places = [folder / "lib", PREFIX / "lib"]
    subprocess.run(
        [
            *(compiler, "-shared", "-fPIC", "-w", "-o", target, *sources),
            *(f"-I{each}" for each in include),
            *(f"-L{each}" for each in places),
            *(f"-Wl,-rpath,{each}" for each in places),
            *(f"-l{each}" for each in needed),
        ],
        check=True,
    )


if __name__ == "__main__":
    build(Path(sys.argv[1]).absolute())
