"""The build backend: scikit-build-core, after a look for a C++ compiler."""

import os
import shutil
import sys

from scikit_build_core.build import *  # noqa: F403
from scikit_build_core.build import build_wheel as _build_wheel
from scikit_build_core.build import get_requires_for_build_wheel as _requires
from scikit_build_core.build import prepare_metadata_for_build_wheel as _prepare


def get_requires_for_build_wheel(config_settings=None):
    _check_compiler()
    return _requires(config_settings)


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    _check_compiler()
    return _prepare(metadata_directory, config_settings)


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    _check_compiler()
    return _build_wheel(wheel_directory, config_settings, metadata_directory)


def _check_compiler():
    """Exit with a sentence where there is no compiler; CMake finds those of macOS and Windows."""
    if sys.platform in ("darwin", "win32"):
        return
    named = os.environ.get("CXX", "").split()
    if not any(map(shutil.which, named[:1] or ["c++", "g++", "clang++"])):
        sys.exit(
            "error: botschool has a part in C++ and there is no C++ compiler: install one (on "
            "Debian and Ubuntu with 'apt-get install g++'), or install botschool from a wheel, "
            "which compiles nothing."
        )
