"""Finds MuJoCo's library."""

import importlib.util
import os
import pathlib

from . import _native


def find():
    """Tell the native part where MuJoCo's library is.

    The variable `VIBRISSA_MUJOCO` has the path of the library. Without it, the library of the Python package `mujoco`
    is used. Without either, the loader of the system looks for it when the first simulation begins.
    """
    if not _native.has_mujoco():
        return
    stated = os.environ.get("VIBRISSA_MUJOCO")
    library = pathlib.Path(stated) if stated else _of_package()
    if library:
        _native.use_mujoco(library)


def _of_package():
    package = importlib.util.find_spec("mujoco")
    folders = package.submodule_search_locations if package else None
    libraries = [file for folder in folders or () for file in sorted(pathlib.Path(folder).glob("libmujoco*.*"))]
    return libraries[0] if libraries else None
