"""Builds the module with CMake, on an installed Ductile or on the sources around this folder.

Options go to CMake by the environment: CMAKE_ARGS, CMAKE_PREFIX_PATH, CMAKE_BUILD_PARALLEL_LEVEL.
"""

import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext


class CMakeBuild(build_ext):
    """The one extension, by the CMakeLists.txt beside this file."""

    def build_extension(self, ext):
        output = Path(self.get_ext_fullpath(ext.name)).resolve().parent
        folder = Path(self.build_temp).resolve() / "cmake"
        ninja = ["-G", "Ninja"] if shutil.which("ninja") else []
        subprocess.run(
            ["cmake", "-S", Path(__file__).resolve().parent, "-B", folder, *ninja,
             f"-DPython_EXECUTABLE={sys.executable}", f"-DDUCTILE_PYTHON_OUTPUT={output}",
             "-DCMAKE_BUILD_TYPE=Release", *self.pybind11(),
             *shlex.split(os.environ.get("CMAKE_ARGS", ""))], check=True)
        jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL") or str(os.cpu_count() or 1)
        subprocess.run(["cmake", "--build", folder, "--target", "ductile_python_module",
                        "-j", jobs], check=True)

    @staticmethod
    def pybind11():
        """Where pip has put pybind11, if it has."""
        try:
            import pybind11
            return [f"-Dpybind11_DIR={pybind11.get_cmake_dir()}"]
        except (ImportError, AttributeError):
            return []


setup(ext_modules=[Extension("ductile._ductile", sources=[])], cmdclass={"build_ext": CMakeBuild})
