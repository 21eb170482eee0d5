"""Reads accepted decks with f90nml too and prints the values that differ: compare.py FOLDER

FOLDER has decks and, for each accepted deck, NAME.resolved beside it.
"""

import pathlib
import sys

import f90nml

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tests"))

from namelist.test_deck_fuzz import differences  # noqa: E402


def main(folder):
    compared = unread = differing = 0
    for path in sorted(folder.glob("*.resolved")):
        deck = path.with_suffix("").read_text(errors="replace", encoding="utf-8-sig")
        ours = f90nml.read(path)
        try:
            meant = f90nml.reads(deck)
            found = list(differences(ours, meant))
        except Exception as trouble:
            unread += 1
            print(f"{path.stem}: f90nml: {trouble!r}")
            continue
        compared += 1
        differing += bool(found)
        for group, key, here, there in found:
            print(f"{path.stem}: &{group} {key}: {here}, f90nml {there}")
    print(f"{compared} compared, {differing} differ, {unread} that f90nml does not read")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
