"""Decks as files of any kind, and the table of keys that --keys prints."""

import os
import re
import subprocess
import threading
import time

import pytest
from support.decks import BODIES, FORCE, GOOD, LOADING, RUNTIME_ERROR
from support.processes import HANG

# --- Files


def refused_file(snapin, path, phrase):
    done = snapin("--check", path)
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.startswith(f"{path}: ")
    assert phrase in done.stderr
    assert not RUNTIME_ERROR.search(done.stderr)


def test_blanks_at_the_end_of_a_name_count(snapin, tmp_path):
    (tmp_path / "d.nml").write_text(GOOD)
    refused_file(snapin, f"{tmp_path}/d.nml ", "no such file")
    (tmp_path / "d.nml  ").write_text(GOOD)
    assert snapin("--check", tmp_path / "d.nml  ").returncode == 0


def test_control_characters_of_a_name_stay_out_of_messages(snapin, tmp_path):
    (tmp_path / "a\n\x1b[31mb\u00e9.nml").write_text("?")
    done = snapin("--check", "a\n\x1b[31mb\u00e9.nml", cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr.startswith("a??[31mb\u00e9.nml:1: ")


@pytest.mark.parametrize("seconds", [0, pytest.param(1.5, marks=pytest.mark.slow)])
def test_a_pipe_is_read_however_long_its_writer_takes(snapin, tmp_path, seconds):
    """The program waits for a pipe that is open for writing."""
    os.mkfifo(tmp_path / "pipe")

    def write():
        with open(tmp_path / "pipe", "w", encoding="utf-8") as pipe:
            for part in GOOD[:20], GOOD[20:]:
                time.sleep(seconds)
                pipe.write(part)
                pipe.flush()

    writer = threading.Thread(target=write)
    writer.start()
    done = snapin("--check", "pipe", cwd=tmp_path)
    writer.join()
    assert (done.returncode, done.stdout) == (0, "pipe: ok\n")


@pytest.mark.slow
@pytest.mark.parametrize("option", ["--check", "--price", "--quiet"])
def test_a_pipe_that_nobody_writes_into_is_refused(snapin, tmp_path, option):
    """It was waited for, for ever."""
    os.mkfifo(tmp_path / "pipe")
    done = snapin(option, "pipe", cwd=tmp_path, timeout=60)
    assert done.returncode == 2
    assert done.stderr == "pipe: cannot be read: no program has opened this pipe for writing\n"


@pytest.mark.parametrize("name", ["/dev/zero", "pipe"])
def test_a_table_is_a_file_since_a_pipe_is_read_once(snapin, tmp_path, name):
    """A pipe without a writer was waited for, without a word."""
    os.mkfifo(tmp_path / "pipe")
    decks = {"force.nml": f"&tabulated file = '{name}', tail_exponent = 3 /\n",
             "sweep.nml": f"{FORCE}&sweep file = '{name}' /\n",
             "curves.nml": f"{FORCE}&measurement file = '{name}', curves = '1', curve = 1, "
                           "columns = '2', '3', spring_constant = 1 /\n"
                           "&fit parameters = 'force.hamaker', 'measurement.contact_point' /\n"
                           "&equilibrium_path h0_end = -1e-9 /\n"}
    for deck, group in decks.items():
        (tmp_path / deck).write_text(BODIES + group + LOADING)
        done = snapin("--check", deck, cwd=tmp_path)
        assert done.returncode == 2
        assert f"{name}: " in done.stderr and "a pipe or a device" in done.stderr


def test_a_deck_without_an_end_is_refused(snapin_path, tmp_path):
    """Standard input was read for ever."""
    with open("/dev/zero", "rb") as endless:
        done = subprocess.run([snapin_path, "--check", "-"], stdin=endless, capture_output=True,
                              text=True, cwd=tmp_path, timeout=HANG, check=False)
    assert done.returncode == 2 and "larger than 1 MiB" in done.stderr


def test_control_characters_of_files_and_names_never_reach_the_terminal(snapin, tmp_path):
    name = "a\x1b[31mb\u009bc"
    (tmp_path / "t.txt").write_text("1e-9 2\n2e-9 \x1b[31mred\n")
    (tmp_path / f"{name}.nml").write_text(
        BODIES + "&tabulated file = 't.txt', tail_exponent = 3 /\n" + LOADING)
    (tmp_path / f"{name}2.nml").write_text(GOOD)
    said = [snapin(*arguments, cwd=tmp_path) for arguments in (
        (f"{name}.nml",), (f"{name}2.nml",), ("--check", f"{name}2.nml"),
        ("--price", f"{name}2.nml"), (f"--{name}",), ("--keys", name), ("--name", name, "-"))]
    assert [done.returncode for done in said] == [2, 0, 0, 0, 2, 2, 2]
    for done in said:
        text = done.stdout + done.stderr
        assert len(text) > 10
        assert not {"\x1b", "\u009b"} & set(text), done.args


def test_what_stands_in_the_way_of_a_file_is_said(snapin, tmp_path):
    (tmp_path / "d.nml").write_text(GOOD)
    (tmp_path / "loop").symlink_to("loop")
    refused_file(snapin, tmp_path / "d.nml" / "x", "Not a directory")
    refused_file(snapin, tmp_path / "loop", "symbolic links")
    refused_file(snapin, tmp_path / ("x" * 300), "too long")
    refused_file(snapin, tmp_path / ("x/" * 3000), "too long")
    refused_file(snapin, tmp_path, "cannot")


def test_unreadable_file_is_refused(snapin, tmp_path):
    deck = tmp_path / "secret.nml"
    deck.write_text(GOOD)
    deck.chmod(0)
    if os.access(deck, os.R_OK):
        pytest.skip("this user may read everything")
    refused_file(snapin, deck, "cannot be opened")


def test_huge_file_is_refused(snapin, tmp_path):
    deck = tmp_path / "huge.nml"
    deck.write_text(GOOD + "! " + "x" * 2_000_000)
    refused_file(snapin, deck, "larger than")


def test_binary_file_is_refused(snapin, snapin_path):
    done = snapin("--check", snapin_path)
    assert done.returncode == 2
    assert not RUNTIME_ERROR.search(done.stderr)


@pytest.mark.parametrize(
    "text",
    ["!\n" * 500_000, "&bodies " * 120_000, "'" * 1_000_000, "&scene title = '" + "''" * 500_000,
     "&scene a=" + "1 " * 500_000, "&scene " + "a=1 " * 250_000 + "/", "&a/" * 300_000,
     "&profiles h0 = " + "1 " * 500_000 + "/", "&scene x((((" + "(" * 900_000],
    ids=["comments", "groups", "quotes", "string", "values", "keys", "unknown groups", "list",
         "parentheses"],
)
def test_pathological_file_is_refused_at_once(snapin, tmp_path, text):
    (tmp_path / "d.nml").write_text(text)
    done = snapin("--check", "d.nml", cwd=tmp_path)
    assert done.returncode == 2
    assert len(done.stderr) < 20_000


# --- The table


def printed_keys(snapin):
    """{group: {key: description}} as --keys prints it, without groups that are skipped."""
    table, keys = {}, None
    for line in snapin("--keys").stdout.splitlines():
        if match := re.match(r"&(\w+)(.*)", line):
            keys = {}
            if "skipped" not in match[2]:
                table[match[1]] = keys
        elif match := re.match(r"  (\w+) +(\S.*)", line):
            keys[match[1]] = match[2]
    return table


SAMPLE = {
    "a number": "0.005", "a whole": "10", "up to": "0.005", ".true.": ".false.", "text in": "'x'"}


def sample_value(description):
    """Some value that a key described so takes."""
    if match := re.match(r"one of ('\w+')", description):
        return match[1]
    if " names in quotes" in description:
        return "'x'"
    if re.search(r" from [12] to \d+", description):
        return "2"
    if " > 1" in description:
        return "9"
    return next(value for start, value in SAMPLE.items() if description.startswith(start))


def test_every_printed_key_is_accepted(snapin, check):
    """Each key in a deck by itself: the other keys may then be missing, but it is known."""
    table = printed_keys(snapin)
    assert len(table) >= 12
    for group, keys in table.items():
        for key, description in keys.items():
            _, _, err = check(f"&{group} {key} = {sample_value(description)} /")
            assert "no such key" not in err
            assert "unknown" not in err
            assert "allowed" not in err, err


def beyond(described):
    """Values that are just not those of a key described so."""
    if described.startswith("one of "):
        return ["'none'"]
    near = 1 if "whole" in described else 1e-9
    if match := re.search(r" from (\S+) to (\S+)", described):
        low, high = (type(near)(end) for end in match.groups())
        return [repr(low - near * (low or 1)), repr(high + near * high)] if near < 1 else [
            str(low - 1), str(high + 1)]
    match = re.search(r" (>=?) (\S+)(?: and (<=?) (\S+))?", described)
    sign, low, other, high = match.groups() if match else (None,) * 4
    return [repr(float(end) + (off if "=" in kind else 0))
            for kind, end, off in ((sign, low, -near), (other, high, near)) if kind]


def test_no_key_takes_what_is_beyond_the_range_that_is_printed(snapin, tmp_path):
    decks = [(group, key, described.partition(";")[0], value)
             for group, keys in printed_keys(snapin).items() for key, described in keys.items()
             for value in beyond(described.partition(";")[0])]
    assert len(decks) > 100
    for i, (group, key, _, value) in enumerate(decks):
        (tmp_path / f"{i}.nml").write_text(f"&{group} {key} = {value} /\n")
    done = snapin("--check", *(f"{i}.nml" for i in range(len(decks))), cwd=tmp_path)
    assert done.returncode == 2 and not done.stdout
    for i, (group, key, described, _) in enumerate(decks):
        said = re.search(rf'^{i}.nml:1: &{group}: key "{key}": (.*)$', done.stderr, re.M)
        assert said and said[1].endswith(described), decks[i]


def test_every_accepted_key_is_printed(snapin, check):
    """The reader lists the keys of a group when it meets a wrong one: the same as --keys."""
    table = printed_keys(snapin)
    _, _, err = check("&no_such_group_at_all /")
    groups = re.search(r"groups are (.*)", err)[1].split(", ")
    assert groups == ["&" + group for group in table]
    for group, keys in table.items():
        _, _, err = check(f"&{group} no_such_key_at_all = 1 /")
        known = re.search(r"keys of &\w+ are (.*)", err)
        assert (known[1].split(", ") if known else []) == list(keys)


def test_keys_name_unit_default_and_meaning(snapin):
    table = printed_keys(snapin)
    assert table["loading"]["h0_step"] == "a number > 0 m; required"
    assert table["numerics"]["accuracy"] == "a number from 1e-10 to 0.1; default 1e-6"
    assert table["force"]["part"].endswith("default: full")
    assert table["bodies"]["poisson"].startswith("up to 2 numbers > -1 and <= 0.5")
    lines = snapin("--keys").stdout.splitlines()
    assert all(len(line) > 30 for line in lines if line.startswith(" " * 20))
