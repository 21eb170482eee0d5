"""Writes the initial decks and words of a campaign: seeds.py SNAPIN FOLDER

FOLDER/seeds/ gets every deck of inputs/ and every small deck text of tests/support/decks.py and of
the tests of bad decks, FOLDER/words.dict the groups, keys and choices of `snapin --keys` and the
difficult parts of namelists.
"""

import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))

from namelist import test_deck  # noqa: E402
from scene import test_deck_scene  # noqa: E402
from support import decks  # noqa: E402

LARGEST = 2000
AWKWARD = ["NaN", "-Inf", "infinity", "1e999", "1d-308", "9.9e300", "2147483647", "-2147483648",
           "2147483647*", "3*1.0", "''", '""', "'it''s'", "(1)", "(1:2)", "%", "&end", "$", "/",
           "!", "\r\n", "\t", "\x00", "\xef\xbb\xbf", ".true.", ".f.", "'force.z0'", "0.5e-9"]


def words(keys):
    """Groups, keys and choices in the text of `snapin --keys`."""
    found = re.findall(r"^&\w+", keys, re.M) + re.findall(r"^  (\w+)", keys, re.M)
    return sorted(set(found + re.findall(r"'\w+'", keys)))


def main(snapin, folder):
    seeds = folder / "seeds"
    seeds.mkdir(parents=True, exist_ok=True)
    texts = [path.read_bytes() for path in sorted((ROOT / "inputs").glob("*.nml"))]
    texts += list(decks.ACCEPTED.values())
    for module in (test_deck, test_deck_scene):
        texts += [case[0] for case in module.REFUSED.values()]
    for i, text in enumerate(texts):
        data = text if isinstance(text, bytes) else text.encode()
        if len(data) <= LARGEST:
            (seeds / f"{i:03}.nml").write_bytes(data)
    keys = subprocess.run([snapin, "--keys"], capture_output=True, text=True, check=True).stdout
    with open(folder / "words.dict", "w", encoding="ascii") as out:
        for word in words(keys) + AWKWARD:
            text = re.sub(r"[^A-Za-z0-9_&.]", lambda c: f"\\x{ord(c[0]):02x}", word)
            out.write(f'"{text}"\n')


if __name__ == "__main__":
    main(sys.argv[1], pathlib.Path(sys.argv[2]))
