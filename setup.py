"""Builds the Python module with CMake, by the preset `release`, and takes what it installs for the wheel."""

import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parent
VERSION = re.search(r"project\(bernal VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1)


class BuildWithCMake(build_ext):
    def run(self):
        def cmake(*arguments):
            subprocess.run(["cmake", *arguments], cwd=ROOT, check=True)

        cmake("--preset", "release", f"-DPython_EXECUTABLE={sys.executable}", "-DBERNAL_PYTHON=ON")
        cmake("--build", "--preset", "release", "--target", "bernal_python_package")
        with tempfile.TemporaryDirectory() as prefix:
            cmake("--install", "build/release", "--component", "python", "--prefix", prefix)
            package = next(Path(prefix).glob("lib/python*/dist-packages/bernal"))
            shutil.copytree(package, Path(self.build_lib) / "bernal", dirs_exist_ok=True)
        for module in (ROOT / "build/release/src").glob("libbernal_opencascade.so"):  # what reads STEP, IGES and BREP
            (Path(self.build_lib) / "bernal/lib").mkdir(exist_ok=True)
            shutil.copy(module, Path(self.build_lib) / "bernal/lib")


setup(version=VERSION, ext_modules=[Extension("bernal._core", [])], cmdclass={"build_ext": BuildWithCMake})
