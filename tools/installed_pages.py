"""Writes the manual page and the completions of bash and zsh for an installed program.

    tools/installed_pages.py PROGRAM FOLDER

All are made from the output of PROGRAM (--help, --keys, --version) alone.
"""

import re
import subprocess
import sys
from pathlib import Path

# `  --out DIR   write to ...` of --help, and its continuation lines.
OPTION = re.compile(r"  (--[a-z]+)(?: ([A-Z]+))? +(\S.*)$")


def says(program, option):
    return subprocess.run([program, option], capture_output=True, text=True, check=True).stdout


def options_of(help_text):
    """(option, its argument or None, its short form or None, its meaning) of every option."""
    found = []
    for line in help_text.splitlines():
        match = OPTION.match(line)
        if match:
            found.append([*match.groups()])
        elif found and line.startswith(" " * 14):
            found[-1][2] += " " + line.strip()
        elif found:
            break
    for option, argument, meaning in found:
        short = re.search(r"\((-[a-z])\)", meaning)
        text = re.sub(r" ?\(-[a-z]\)", "", meaning)
        yield option, argument, short.group(1) if short else None, text


def roff(text):
    """Text for troff: a line must not begin with a request, nor a minus become a hyphen."""
    lines = text.replace("\\", "\\e").replace("-", "\\-").replace("'", "\\(aq").splitlines()
    return "\n".join("\\&" + line if line.startswith(".") else line for line in lines)


def verbatim(text):
    return f".nf\n{roff(text)}\n.fi"


def manual(help_text, keys, version):
    usage, rest = help_text.split("\n", 1)
    about = rest.split("\n\n")[0].strip()
    _, status = rest.split("\n\nExit status: ")
    status, deck = status.split("\n\n", 1)
    parts = [f'.TH SNAPIN 1 "" "snapin {version}" "User commands"',
             ".SH NAME", roff("snapin - elastic deformation and adhesion of two bodies in contact"),
             ".SH SYNOPSIS", roff(usage.removeprefix("usage: ")),
             ".SH DESCRIPTION", roff(about), ".SH OPTIONS"]
    for option, argument, short, meaning in options_of(help_text):
        parts += [".TP", ".B " + roff(option + (f", {short}" if short else "")) +
                  (f" \\fI{argument}\\fR" if argument else ""), roff(meaning)]
    parts += [".SH EXIT STATUS", roff(status), ".SH EXAMPLE", verbatim(deck.strip("\n")),
              ".SH GROUPS AND KEYS OF A DECK", verbatim(keys.strip("\n"))]
    return "\n".join(parts) + "\n"


def names_of(keys):
    """Every group, and every key as group.key, in the text of --keys."""
    for line in keys.splitlines():
        if match := re.match(r"&(\w+)(?!\w| \(skipped\))", line):
            group = match[1]
            yield group
        elif match := re.match(r"  (\w+) ", line):
            yield f"{group}.{match[1]}"


def bash(options, names_of_keys):
    folders, names = (
        "|".join(word for option, argument, short, _ in options if argument == kind
                 for word in (option, short) if word) for kind in ("DIR", "NAME"))
    words = " ".join(word for option, _, short, _ in options for word in (option, short) if word)
    return f"""# Completion of snapin for bash.
_snapin() {{
    local word=${{COMP_WORDS[COMP_CWORD]}}
    compopt -o filenames
    case ${{COMP_WORDS[COMP_CWORD - 1]}} in
        {folders}) mapfile -t COMPREPLY < <(compgen -d -- "$word") ;;
        {names}) COMPREPLY=() ;;
        --keys) mapfile -t COMPREPLY < <(compgen -W '{" ".join(names_of_keys)}' -- "$word") ;;
        *) case $word in
            -*) compopt +o filenames
                mapfile -t COMPREPLY < <(compgen -W '{words}' -- "$word") ;;
            *) mapfile -t COMPREPLY < <(compgen -d -- "$word"; compgen -f -X '!*.nml' -- "$word") ;;
        esac ;;
    esac
}}
complete -F _snapin snapin
"""


def zsh(options, names_of_keys):
    def spec(option, argument, short, meaning):
        meaning = re.sub(r"([\[\]:\\])", r"\\\1", meaning).replace("'", "'\\''")
        action = {"DIR": ":folder:_files -/", "NAME": ":name:", None: ""}[argument]
        if option == "--keys":
            action = f"::group or key:({' '.join(names_of_keys)})"
        forms = [option] + ([short] if short else [])
        return [f"    '({' '.join(forms)}){form}[{meaning}]{action}' \\" for form in forms]

    lines = [line for option in options for line in spec(*option)]
    return "\n".join(["#compdef snapin", "# Completion of snapin for zsh.", "_arguments \\", *lines,
                      "    '*:deck:_files -g \"*.nml\"'", ""])


def main():
    program, folder = sys.argv[1], Path(sys.argv[2])
    help_text = says(program, "--help")
    options = list(options_of(help_text))
    version = says(program, "--version").split()[1]
    keys = says(program, "--keys")
    names = list(names_of(keys))
    (folder / "snapin.1").write_text(manual(help_text, keys, version))
    (folder / "snapin.bash").write_text(bash(options, names))
    (folder / "_snapin").write_text(zsh(options, names))


if __name__ == "__main__":
    main()
