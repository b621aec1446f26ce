"""Makes a wheel of the Python package fiber_proximity: CMake builds its module and the libraries that this loads, without
ROS, into it. Needs what scripts/setup.sh installs.

CMAKE_ARGS in the environment is handed on to CMake; MAX_JOBS says how many compilers run at once. Where
FIBER_PROXIMITY_BUILD names a build of CMake, its module is taken.
"""
import os
import pathlib
import re
import shlex
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent
# Not `build`, which is CMake's own.
BUILD = ROOT / 'build-wheel'


class BuildByCMake(build_ext):
    """Has CMake install the component `wheel` where setuptools collects what goes into the wheel."""

    def build_extension(self, ext):
        package = pathlib.Path(self.get_ext_fullpath(ext.name)).resolve().parent
        build = os.environ.get('FIBER_PROXIMITY_BUILD') or self.build_module()
        subprocess.check_call(['cmake', '--install', str(build), '--component', 'wheel', '--prefix', str(package.parent)])

    @staticmethod
    def build_module():
        build = BUILD / f'cmake-{sys.version_info.major}.{sys.version_info.minor}'
        jobs = os.environ.get('MAX_JOBS', str(os.cpu_count() or 1))
        subprocess.check_call([
            'cmake', '-S', str(ROOT), '-B', str(build), '-DFIBER_PROXIMITY_BUILD_ROS=OFF',
            '-DFIBER_PROXIMITY_BUILD_BENCHMARKS=OFF', '-DBUILD_TESTING=OFF', f'-DPYTHON_EXECUTABLE={sys.executable}',
            f'-DPython3_EXECUTABLE={sys.executable}', *shlex.split(os.environ.get('CMAKE_ARGS', ''))])
        subprocess.check_call(['cmake', '--build', str(build), '--target', 'fiber_proximity_python', '--parallel', jobs])
        return build


def version():
    return re.search(r'project\(fiber_proximity VERSION (\S+)', (ROOT / 'CMakeLists.txt').read_text(encoding='utf-8'))[1]


BUILD.mkdir(exist_ok=True)
setup(
    name='fiber_proximity',
    version=version(),
    description='Proximity queries for cables, ropes, hair and other fibres',
    license='BSD-3-Clause',
    python_requires='>=3.8',
    install_requires=['numpy'],
    # The package's files come by CMake, too.
    packages=[],
    ext_modules=[Extension('fiber_proximity._native', sources=[])],
    cmdclass={'build_ext': BuildByCMake},
    options={'build': {'build_base': str(BUILD)}, 'egg_info': {'egg_base': str(BUILD)}},
)
