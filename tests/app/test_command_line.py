"""The command line: options, exit status, and that a wrong deck leaves nothing behind."""

import os
import shlex
import shutil
import subprocess

import pytest
from conftest import ROOT
from support.processes import HANG, status_and_memory

# The cheapest thing the program can do.
DECK = """&bodies radius = 1e-2, stiffness = 1e10 /
&force law = 'lennard_jones', hamaker = 1e-19, z0 = 5e-10 /
&classical h0_start = 2e-9, h0_end = -1e-9, count = 5 /
"""
BAD = DECK.replace("radius", "raduis")


@pytest.fixture
def decks(tmp_path):
    """A folder with good.nml, other.nml, bad.nml, worse.nml and sub/good.nml."""
    (tmp_path / "sub").mkdir()
    for name, text in [("good.nml", DECK), ("other.nml", DECK), ("bad.nml", BAD),
                       ("worse.nml", "?"), ("sub/good.nml", DECK)]:
        (tmp_path / name).write_text(text)
    return tmp_path


def files_in(folder):
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))


@pytest.mark.parametrize("option", ["--help", "--keys", "--results", "--version"])
def test_information_goes_to_stdout_with_status_0(snapin, decks, option):
    before = files_in(decks)
    done = snapin(option, cwd=decks)
    assert done.returncode == 0
    assert done.stdout.strip()
    assert done.stderr == ""
    assert files_in(decks) == before


@pytest.mark.parametrize("options", [
    ("--help",), ("--keys",), ("--keys", "sweep"), ("--results",), ("--version",),
    ("--check", "good.nml"), ("--out", "-", "good.nml"), ("--out", "-", "--into", "x", "good.nml")],
    ids=" ".join)
@pytest.mark.parametrize("stream", ["full", "closed", "unread"])
def test_what_standard_output_does_not_take_is_told(snapin_path, decks, options, stream):
    """--keys and --check into a full device ended with status 0, and results that went to a closed
    stream were lost with status 0."""
    reader, writer = os.pipe()
    os.close(reader)
    out = os.open("/dev/full", os.O_WRONLY) if stream == "full" else writer
    done = subprocess.run(
        [snapin_path, *options], cwd=decks, stdout=out, stderr=subprocess.PIPE, text=True,
        timeout=HANG, check=False,
        preexec_fn=(lambda: os.close(1)) if stream == "closed" else None)
    os.close(writer)
    if stream == "unread" and "-" in options and done.returncode < 0:
        # Nobody reads the results: the program has ended as with its parent.
        return
    assert done.returncode == 1
    assert "cannot write" in done.stderr
    assert ("snapin: cannot write to standard output: " in done.stderr) == ("-" not in options)


def test_results_go_to_a_folder_and_to_standard_output_at_once(snapin, decks):
    """The stream has the folder's files, each in one piece, and then its end."""
    done = snapin("--out", "-", "--into", "x", "--quiet", "good.nml", cwd=decks)
    assert done.returncode == 0
    texts = {name: (decks / "x" / name).read_text() for name in ("classical.csv", "summary.nml")}
    assert done.stdout == "".join(
        f"{name} {len(text)}\n{text}" for name, text in texts.items()) + "complete 0\n"
    again = snapin("--out", "-", "--into", "x", "--quiet", "--resume", "good.nml", cwd=decks)
    assert again.stdout == done.stdout
    for options in (("--into", "-"), ("--into=-",), ("--out", "x", "--into", "y")):
        done = snapin(*options, "good.nml", cwd=decks)
        assert done.returncode == 2 and done.stdout == ""


def test_keys_that_are_named_are_those_of_the_list(snapin):
    every = snapin("--keys").stdout
    group = snapin("--keys", "Sweep").stdout
    assert group in every and group.startswith("\n&sweep\n") and group.count("\n&") == 1
    key = snapin("--keys", "sweep.file").stdout
    assert [line.split()[0] for line in key.splitlines() if line[:3] > "   "] == ["&sweep", "file"]
    both = snapin("--keys", "sweep", "force.law").stdout
    assert both.count("\n&") == 2 and group in both
    for wrong in ("swep", "sweep.fil"):
        done = snapin("--keys", wrong)
        assert done.returncode == 2 and done.stdout == ""
        assert f"no group or key '{wrong}'" in done.stderr


def test_help_names_every_option(snapin):
    text = snapin("--help").stdout
    for option in ["--out", "--check", "--price", "--resume", "--quiet", "--verbose", "--keys",
                   "--results", "--version", "--help"]:
        assert f"\n  {option} " in text


def test_deck_in_the_help_is_valid(snapin, tmp_path):
    example = snapin("--help").stdout.split("A deck to start from")[1].split("\n", 1)[1]
    (tmp_path / "example.nml").write_text(example)
    done = snapin("--check", "example.nml", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (0, "example.nml: ok\n"), done.stderr


@pytest.mark.parametrize("option", ["--version", "--help", "--keys", "--results"])
def test_of_several_processes_the_first_answers(snapin, monkeypatch, option):
    """Under mpirun each process printed all of it."""
    monkeypatch.setenv("OMPI_COMM_WORLD_SIZE", "2")
    said = []
    for rank in "01":
        monkeypatch.setenv("OMPI_COMM_WORLD_RANK", rank)
        done = snapin(option)
        assert done.returncode == 0
        said.append(done.stdout)
    assert said[0] and not said[1]


@pytest.mark.parametrize(
    "args, phrase",
    [
        ([], "no deck"),
        (["--check"], "no deck"),
        (["--quiet", "--"], "no deck"),
        (["--chek", "good.nml"], 'unknown option "--chek" (did you mean "--check"?)'),
        (["-x", "good.nml"], 'unknown option "-x"'),
        (["--check=1", "good.nml"], 'unknown option "--check=1"'),
        (["--help", "--nonsense"], "unknown option"),
        (["good.nml", "--out"], "--out needs a folder"),
        (["--out", "", "good.nml"], "--out needs a folder"),
        (["--out=", "good.nml"], "--out needs a folder"),
        (["--into=", "good.nml"], "--into needs a folder"),
        (["--name=", "-"], "--name needs a name"),
        (["--out", "a", "--into=b", "good.nml"], "give --out or --into, not both"),
        (["--name", "other", "good.nml"], "--name is for a deck on standard input"),
        (["--name", "..", "-"], '--name needs a name for a folder, not ".."'),
        (["--name", "a/", "-"], '--name needs a name for a folder, not "a/"'),
        (["--price"], "no deck"),
        (["--prise", "good.nml"], 'did you mean "--price"?'),
        *((["--price", *with_, "good.nml"], "--price prints a table and writes no results")
          for with_ in (["--check"], ["--resume"], ["--out", "a"], ["--into=a"])),
        (["good.nml", "good.nml"], "would both write to the folder good"),
        (["good.nml", "other.nml", "sub/good.nml"], "good.nml and sub/good.nml"),
        (["--name", "good", "good.nml", "-"], "good.nml and - would both write"),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else "",
)
def test_wrong_command_line_is_refused_with_a_hint(snapin, decks, args, phrase):
    before = files_in(decks)
    done = snapin(*args, cwd=decks)
    assert done.returncode == 2
    assert done.stdout == ""
    assert phrase in done.stderr
    assert "usage: snapin" in done.stderr
    assert files_in(decks) == before


def test_check_reports_every_deck_good_or_bad(snapin, decks):
    before = files_in(decks)
    done = snapin("--check", "good.nml", "bad.nml", "other.nml", "worse.nml", "none.nml", cwd=decks)
    assert done.returncode == 2
    assert done.stdout == "good.nml: ok\nother.nml: ok\n"
    assert "bad.nml:1: &bodies: key \"raduis\"" in done.stderr
    assert "worse.nml:1: " in done.stderr
    assert "none.nml: no such file" in done.stderr
    assert files_in(decks) == before


def test_check_minds_no_equal_names(snapin, decks):
    done = snapin("--check", "good.nml", "sub/good.nml", cwd=decks)
    assert (done.returncode, done.stdout) == (0, "good.nml: ok\nsub/good.nml: ok\n")


def test_one_bad_deck_stops_all_before_anything_is_written(snapin, decks):
    before = files_in(decks)
    done = snapin("--quiet", "good.nml", "other.nml", "bad.nml", cwd=decks)
    assert done.returncode == 2
    assert done.stdout == ""
    assert "bad.nml:1: " in done.stderr
    assert files_in(decks) == before


@pytest.mark.parametrize("args, folder", [
    (["--out", "here/there"], "here/there/good"), (["--out=here/there"], "here/there/good"),
    (["--into", "here/there"], "here/there"), (["--into=here/there"], "here/there")])
def test_out_chooses_another_folder_and_into_the_folder_itself(snapin, decks, args, folder):
    done = snapin("--quiet", "sub/good.nml", *args, cwd=decks)
    assert done.returncode == 0, done.stderr
    assert (decks / folder / "summary.nml").is_file()
    assert not (decks / "results").exists()


def test_deck_may_begin_with_a_dash_after_double_dash(snapin, decks):
    (decks / "-d.nml").write_text(DECK)
    done = snapin("--check", "--", "-d.nml", cwd=decks)
    assert (done.returncode, done.stdout) == (0, "-d.nml: ok\n")


@pytest.mark.parametrize("name", ["..nml", "...nml", ".nml"])
def test_results_stay_inside_the_folder_whatever_the_deck_is_called(snapin, decks, name):
    (decks / name).write_text(DECK)
    done = snapin("--quiet", name, "--out", "here/there", cwd=decks)
    assert done.returncode == 0, done.stderr
    assert (decks / "here" / "there" / name / "summary.nml").is_file()
    assert files_in(decks / "here") == ["there"] + sorted(
        f"there/{name}{file}" for file in ["", "/classical.csv", "/summary.nml"])


@pytest.mark.parametrize("name", [
    "my deck.v2.nml", "a\nb.nml", "q'\".nml", "\u00e9\u221e.nml", "*.nml", "a\\b.nml"])
def test_a_deck_may_be_called_anything(snapin, decks, name):
    (decks / name).write_text(DECK)
    done = snapin("--quiet", name, cwd=decks)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert (decks / "results" / name.removesuffix(".nml") / "summary.nml").is_file()


def test_a_thousand_decks_are_checked_in_little_status_and_memory(snapin_path, decks):
    names = [f"d{i}.nml" for i in range(1000)]
    for name in names:
        (decks / name).write_text(DECK)
    _, alone = status_and_memory(snapin_path, "--check", names[0], cwd=decks)
    status, used = status_and_memory(snapin_path, "--check", *names, cwd=decks)
    assert status == 0
    # A deck is its text and one value a key: of some 350 keys with less than 400 bytes each.
    assert used < alone + 1000 * 135e3


def test_no_more_of_an_endless_file_is_read_than_a_deck_may_hold(snapin_path, decks):
    with open(decks / "large.nml", "wb") as file:
        file.truncate(100_000_000)
    _, alone = status_and_memory(snapin_path, "--check", "good.nml", cwd=decks)
    for name in ["large.nml", "/dev/zero"]:
        status, used = status_and_memory(snapin_path, "--check", name, cwd=decks)
        assert status == 2
        assert used < alone + 10e6


def test_results_on_standard_output_have_no_folder(snapin_path, decks):
    """A command was shown that draws the folder snapin, and advice to go on with --resume."""
    (decks / "sweep.nml").write_text(DECK + "&sweep key = 'bodies.radius', values = 1e-2, 2e-2 /")
    with open("/dev/full", "wb") as full:
        for out, status in ((subprocess.PIPE, 0), (full, 1)):
            done = subprocess.run([snapin_path, "--out", "-", "sweep.nml"], cwd=decks, stdout=out,
                                  stderr=subprocess.PIPE, text=True, timeout=HANG, check=False)
            assert done.returncode == status and done.stderr
            assert "map.py" not in done.stderr and "--resume" not in done.stderr


def test_the_command_that_draws_a_sweep_is_one_of_the_shell(snapin, decks):
    name = "it's a $weep"
    (decks / f"{name}.nml").write_text(
        DECK + "&sweep key = 'bodies.radius', values = 1e-2, 2e-2 /")
    said = snapin(f"{name}.nml", cwd=decks).stderr
    assert shlex.split(said.partition("to draw it: ")[2])[2:] == [f"results/{name}"]


# --- The commands at the top of the checkout


@pytest.mark.parametrize("name, character", [("a:b", "a colon"), ("a\nb", "a line end"),
                                             ("a\\b", "a backslash"), ("a=b", "an equals sign")])
def test_a_checkout_in_a_path_that_cannot_be_built_in_is_refused_at_once(tmp_path, name, character):
    top = tmp_path / name / "checkout"
    (top / "tools").mkdir(parents=True)
    shutil.copy(ROOT / "tools/setup.sh", top / "tools")
    for command in ("run", "test"):
        shutil.copy(ROOT / command, top)
        done = subprocess.run([top / command, "deck.nml"], capture_output=True, text=True,
                              timeout=10, check=False)
        assert done.returncode == 2
        assert character in done.stderr
        assert "move or clone it" in done.stderr
        assert sorted(path.name for path in top.iterdir()) == sorted(["tools", "run", "test"][
            : 2 if command == "run" else 3])


def test_a_checkout_may_have_blanks_and_quotes_in_its_path(tmp_path):
    top = tmp_path / "it's a \"test\" [1] $x"
    (top / "tools").mkdir(parents=True)
    shutil.copy(ROOT / "tools/setup.sh", top / "tools")
    script = 'top=$1; . "$top/tools/setup.sh"; refuse_path; echo fine'
    done = subprocess.run(["sh", "-c", script, "sh", top], capture_output=True, text=True,
                          timeout=10, check=False)
    assert done.stdout == "fine\n"
