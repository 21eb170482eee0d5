"""The deck reader against thousands of damaged decks: it accepts or refuses, and never misreads.

Random but the same in every run; `tools/fuzz/` has the search that is led by coverage.
"""

import random
import re

import f90nml
import pytest
from conftest import ROOT
from support.decks import ACCEPTED, FULL, GOOD, RUNTIME_ERROR

INPUTS = ROOT / "inputs"
SOURCES = [path.read_bytes() for path in sorted(INPUTS.glob("*.nml"))] + [
    text if isinstance(text, bytes) else text.encode()
    for text in [FULL, *ACCEPTED.values()]
    if len(text) < 2000
]
# A deck of which every key shows in the summary of a run that takes no time.
CHEAP = b"""! a comment, then every kind of value
&scene title = 'it''s "so"' /
&bodies radius = 0.1, young = 1.1e10, 3.e9
  poisson = 2*.3, rigid = .false. / &force law = 'lennard_jones', hamaker = 1.25D-19, z0=3d-10
  part = "full" /
&classical h0_start = 2e-9, ! here
  h0_end = -1e-9, count = 5 /
&numerics accuracy = 1e-4, nodes = +400, method = 'auto' /
"""

AWKWARD = [
    b"/", b"&", b"&end", b"'", b'"', b"''", b"!", b",", b",,", b"=", b"==", b"(", b")", b"(1)",
    b"(1:2)", b"%", b"*", b"3*", b"3*1.0", b"2147483647*1", b"99999999999*1", b"0*1", b"-1*1",
    b"NaN", b"-Inf", b"infinity", b"1e999", b"-1e-999", b"1e2147483647", b"10e2147483647", b"1d5",
    b"1q5", b"1+5", b"1.0.0", b"1e", b"0", b"-1", b"-0.0", b"00012", b"9999999999999999999", b"1_8",
    b".true.", b".T", b"F", b"tomato", b"\0", b"\x7f", b"\x1b[31m", b"\xff", b"\xc3\xa9",
    b"\xef\xbb\xbf", b"\xe2\x88\x921", b"\r", b"\r\n", b"\n", b"\t", b"\x0c", b" ", b"$", b";",
    b"@", b"#", b"x" * 300, b"1" * 300, b"1 " * 1100, b"!" + b"-" * 5000, b"&scene /", b"&summary",
    b"&sweep key = 'bodies.radius' values = 1 /", b"&sweep key='loading.h0_end', from=-1, to=1, ",
]


@pytest.fixture(scope="module")
def words(snapin):
    """Groups with their ampersand, keys and choices, as --keys prints them."""
    keys = snapin("--keys").stdout
    found = re.findall(r"^&\w+|^  \w+(?= )|'\w+'", keys, re.M)
    return sorted({word.strip().encode() for word in found})


def damaged(rng, words, text):
    """The text with one to four random changes."""
    for _ in range(rng.choice([1, 1, 1, 2, 3, 4])):
        at = rng.randint(0, len(text))
        end = min(len(text), at + rng.choice([0, 1, 1, 2, 5, 20]))
        kind = rng.randrange(11)
        if kind == 0:  # lost
            text = text[:at] + text[end:]
        elif kind == 1:  # put in
            text = text[:at] + rng.choice(AWKWARD) + text[at:]
        elif kind == 2:  # put in place of a word
            tokens = [m.span() for m in re.finditer(rb"[^\s,=]+", text)] or [(0, 0)]
            start, end = rng.choice(tokens)
            text = text[:start] + rng.choice(AWKWARD + words) + text[end:]
        elif kind == 3:  # a word of another place
            text = text[:at] + rng.choice(words) + rng.choice([b"", b" ", b" = "]) + text[end:]
        elif kind == 4:  # repeated
            text = text[:end] + text[at:]
        elif kind == 5:  # moved
            other = rng.randint(0, len(text))
            text = text[:other] + text[at:end] + text[other:]
        elif kind == 6 and text:  # a bit
            at = rng.randrange(len(text))
            text = text[:at] + bytes([text[at] ^ (1 << rng.randrange(8))]) + text[at + 1:]
        elif kind == 7:  # two lines change places
            lines = text.split(b"\n")
            i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
            lines[i], lines[j] = lines[j], lines[i]
            text = b"\n".join(lines)
        elif kind == 8:  # a whole group again
            groups = re.findall(rb"&\w[^/]*/", text)
            text += rng.choice(groups) if groups else b"/"
        elif kind == 9:  # white space, which means nothing
            text = re.sub(rb"[ \n]+", rng.choice([b"\n", b"\t ", b"  ", b"\r\n"]), text, count=20)
        else:  # another number
            numbers = [m.span() for m in re.finditer(rb"[-+]?\d[\d.]*(?:[ed][-+]?\d+)?", text)]
            if numbers:
                start, end = rng.choice(numbers)
                number = b"%d%s%s" % (rng.randint(-9, 99), rng.choice([b"", b".", b".5"]),
                                      rng.choice([b"", b"e-9", b"d%d" % rng.randint(-60, 60)]))
                text = text[:start] + number + text[end:]
    return text


def checked(snapin, folder, texts):
    """{name: whether accepted} of decks that one process checks; the claims that hold for all."""
    decks = {f"d{i:04}.nml": text for i, text in enumerate(texts)}
    for name, text in decks.items():
        (folder / name).write_bytes(text)
    done = snapin("--check", *decks, cwd=folder)
    assert not RUNTIME_ERROR.search(done.stderr + done.stdout), done.stderr
    assert {path.name for path in folder.iterdir()} == set(decks)
    assert all((folder / name).read_bytes() == text for name, text in decks.items())

    accepted = re.findall(r"^(.*): ok$", done.stdout, re.M)
    assert len(accepted) == len(done.stdout.splitlines()) == len(set(accepted))
    refused = set()
    for line in done.stderr.splitlines():
        # The mistake, the line it is in, the caret below, or the end of many mistakes.
        if match := re.match(r"(d\d{4}\.nml):(\d+): \S", line):
            refused.add(match[1])
            ends = decks[match[1]].count(b"\n") + decks[match[1]].count(b"\r") + 1
            assert 1 <= int(match[2]) <= ends
        elif match := re.match(
                r"snapin: (d\d{4}\.nml): .*"
                r"(may take|its results take|not computed: |a sweep writes no|warning: )", line):
            # What is accepted may be long or too large, leave tables out, or promise no success.
            assert match[1] in accepted
        else:
            assert re.match(r" {4}( *\d+| +) \| |further mistakes are not shown$", line), line
        assert len(line) < 1500
    assert refused.isdisjoint(accepted)
    assert refused | set(accepted) == set(decks)
    assert done.returncode == (2 if refused else 0)
    return {name: name not in refused for name in decks}


@pytest.mark.parametrize("seed", range(5))
def test_a_damaged_deck_is_accepted_or_refused_by_line(snapin, tmp_path, words, seed):
    rng = random.Random(seed)
    texts = [damaged(rng, words, rng.choice(SOURCES)) for _ in range(1000)]
    outcome = checked(snapin, tmp_path, texts)
    # Otherwise the damage says nothing about one of the two.
    assert 100 < sum(outcome.values()) < 900


@pytest.mark.parametrize("source", [GOOD.encode(), CHEAP], ids=["plain", "every kind of value"])
def test_a_deck_cut_off_anywhere_is_accepted_or_refused_by_line(snapin, tmp_path, source):
    outcome = checked(snapin, tmp_path, [source[:n] for n in range(len(source))])
    # The groups it needs are complete in a few of them only.
    assert 0 < sum(outcome.values()) < len(source) // 4


def plain(key, value):
    """A value as a list in which only what differs in meaning differs: numbers are reals, the case
    of choices and blanks at the end of a text do not count."""
    for item in value if isinstance(value, list) else [value]:
        if isinstance(item, str):
            text = item.rstrip(" ")
            yield text if key == "title" else text.lower()
        else:
            yield item if isinstance(item, bool) else float(item)


def differences(read, meant):
    """What the program has read otherwise than f90nml; it passes over old results."""
    for group, keys in meant.items():
        if group in ("summary", "cost"):
            continue
        for key, value in keys.items():
            ours = list(plain(key, read.get(group, {}).get(key, [])))
            if ours != list(plain(key, value)):
                yield group, key, ours, value


def summaries(snapin, folder, decks):
    """{name: summary} of decks {name: bytes} that one process runs in `folder`."""
    folder.mkdir()
    for name, text in decks.items():
        (folder / name).write_bytes(text)
    done = snapin("--quiet", *decks, cwd=folder)
    assert done.returncode in (0, 1)
    assert not RUNTIME_ERROR.search(done.stderr + done.stdout), done.stderr
    return {
        name: (folder / "results" / name.removesuffix(".nml") / "summary.nml").read_bytes()
        for name in decks
    }


@pytest.fixture(scope="module")
def accepted(snapin, tmp_path_factory, words):
    """({name: deck}, {name: summary}) of cheap damaged decks that are accepted."""
    rng = random.Random(7)
    texts = {damaged(rng, words, CHEAP) for _ in range(4000)}
    # A million points would be no more to read than five.
    texts = sorted(text for text in texts if re.search(rb"count\s*=\s*5\b", text))
    outcome = checked(snapin, tmp_path_factory.mktemp("check"), texts)
    decks = {name: texts[i] for i, name in enumerate(outcome) if outcome[name]}
    assert len(decks) > 250
    return decks, summaries(snapin, tmp_path_factory.mktemp("run") / "here", decks)


def deck_in(summary):
    """The part of a summary that holds the deck, every default written out."""
    return re.sub(rb"&(summary|cost)\n(?:  .*\n)*/\n", b"", summary)


@pytest.mark.slow
def test_an_accepted_deck_means_what_another_reader_makes_of_it(accepted):
    for deck, summary in zip(*(by_name.values() for by_name in accepted)):
        # To f90nml a group that begins in a comment is a group.
        if re.search(rb"![^\r\n]*&", deck):
            continue
        meant = f90nml.reads(deck.decode(errors="replace"))
        assert not list(differences(f90nml.reads(summary.decode()), meant)), deck


@pytest.mark.slow
def test_the_summary_of_an_accepted_deck_is_a_deck_that_says_the_same(snapin, tmp_path, accepted):
    again = summaries(snapin, tmp_path / "again", accepted[1])
    for name, summary in accepted[1].items():
        assert deck_in(again[name]) == deck_in(summary), name
