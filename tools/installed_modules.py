"""Copies the module files of the library for programs of others: Meson runs it at installation.

    tools/installed_modules.py FOLDER_OF_THE_BUILD FOLDER_IN_THE_PREFIX
"""

import os
import pathlib
import shutil
import sys


def main(build, place):
    folder = pathlib.Path(os.environ["MESON_INSTALL_DESTDIR_PREFIX"], place)
    folder.mkdir(parents=True, exist_ok=True)
    for module in sorted(pathlib.Path(build).glob("*.mod")):
        shutil.copy(module, folder)


if __name__ == "__main__":
    main(*sys.argv[1:])
