"""Builds the compiled part with CMake, of the objects that the program is made of.

The build tree is MOREAU_BUILD, else `build` beside `cli`: where it is there already, only the module is compiled.
"""

import os
import pathlib
import shutil
import subprocess
import sys
import sysconfig

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import write_stubs  # noqa: E402

SOURCE = pathlib.Path(__file__).resolve().parents[2]
TREE = pathlib.Path(os.environ.get("MOREAU_BUILD", SOURCE / "build"))
WORK = TREE / "python" / "setuptools"
WORK.mkdir(parents=True, exist_ok=True)


MADE = TREE / "python" / f"_moreau{sysconfig.get_config_var('EXT_SUFFIX')}"


class ByCMake(build_ext):
    def build_extension(self, extension):
        if not MADE.exists():
            options = ["-DMOREAU_PYTHON=ON", f"-DPYTHON_EXECUTABLE={pathlib.Path(sys.executable).resolve()}"]
            if not (TREE / "CMakeCache.txt").exists() and shutil.which("ninja"):
                options += ["-G", "Ninja"]
            subprocess.run(["cmake", "-S", str(SOURCE), "-B", str(TREE), *options], check=True)
        subprocess.run(["cmake", "--build", str(TREE), "--target", "moreau_python"], check=True)
        into = pathlib.Path(self.get_ext_fullpath(extension.name)).parent
        into.mkdir(parents=True, exist_ok=True)
        # moreau_arb and moreau_ceres are loaded when they are asked for.
        for made in (MADE, TREE / "moreau_arb.so", TREE / "moreau_ceres.so"):
            if made.exists():
                shutil.copyfile(made, into / made.name)
        write_stubs.write(MADE, into)


setup(
    ext_modules=[Extension("moreau._moreau", sources=[])],
    cmdclass={"build_ext": ByCMake},
    options={"build": {"build_base": str(WORK)}, "egg_info": {"egg_base": str(WORK)}},
)
