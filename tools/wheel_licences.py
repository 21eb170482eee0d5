#!/usr/bin/env python3
"""Puts the licences of the libraries that are inside a wheel beside that of the package.

    tools/wheel_licences.py WHEEL [WHEEL ...]

auditwheel has copied the libraries into `snapin.libs`, and the program carries static ones of the
same packages. Each is looked up among Debian's packages; the copyright file of its package, and the
general licences that this names, go into the wheel's metadata, whose licence then is that of all
parts. A library without a known licence is an error.
"""

import base64
import csv
import hashlib
import io
import os
import re
import subprocess
import sys
import zipfile
from pathlib import Path

GCC = "GPL-3.0-or-later WITH GCC-exception-3.1"
# By the beginning of the library's name.
LICENCES = {"libopenblas": "BSD-3-Clause", "libgfortran": GCC, "libgomp": GCC, "libgcc_s": GCC,
            "libquadmath": "LGPL-2.1-or-later"}
DOCUMENTS, COMMON = Path("/usr/share/doc"), Path("/usr/share/common-licenses")


def package_of(library):
    """The package of a library whose name in the wheel has a checksum in it."""
    name = re.sub(r"-[0-9a-f]{8}(?=\.)", "", library)
    found = subprocess.run(["dpkg-query", "--search", f"*/{name}"], capture_output=True, text=True,
                           check=False)
    if found.returncode:
        sys.exit(f"no package has {name}, which is inside the wheel: its licence is not known")
    return found.stdout.split(":")[0]


def licences_of(libraries):
    """The expression of their licences, and the texts by the names of their files."""
    terms, texts = [], {}
    for library in sorted(libraries):
        term = next((term for name, term in LICENCES.items() if library.startswith(name)), None)
        if term is None:
            sys.exit(f"the licence of {library}, which is inside the wheel, is not known")
        terms += [term] * (term not in terms)
        text = (DOCUMENTS / package_of(library) / "copyright").read_text(encoding="utf-8")
        if text not in texts.values():
            texts[f"{library.split('-')[0].split('.')[0]}.txt"] = text
        for general in ("GPL-3", "LGPL-2.1"):
            if general.split("-")[0] in re.split(r"\W", term):
                texts[f"{general}.txt"] = (COMMON / general).read_text(encoding="utf-8")
    return terms, texts


def in_brackets(term):
    return f"({term})" if " " in term else term


def complete(wheel):
    with zipfile.ZipFile(wheel) as archive:
        entries = [(info, archive.read(info)) for info in archive.infolist()]
    terms, texts = licences_of(Path(info.filename).name for info, _ in entries
                               if re.match(r"\w+\.libs/.", info.filename))
    about, = (info.filename[:-len("METADATA")] for info, _ in entries
              if re.fullmatch(r"[^/]+\.dist-info/METADATA", info.filename))
    names = {f"libraries/{name}": text for name, text in texts.items()}
    if any(info.filename == f"{about}licenses/{name}" for info, _ in entries for name in names):
        sys.exit(f"{wheel}: has the licences of its libraries already")
    made = []
    for info, content in entries:
        if info.filename == f"{about}METADATA":
            text = content.decode("utf-8")
            own = re.search(r"^License-Expression: (.*)$", text, re.MULTILINE)
            files = "".join(f"License-File: {name}\n" for name in names)
            whole = " AND ".join([own[1], *map(in_brackets, terms)])
            content = text.replace(own[0], f"License-Expression: {whole}\n{files}".rstrip(), 1)
            content = content.encode("utf-8")
        if info.filename != f"{about}RECORD":
            made.append((info, content))
    made += [(f"{about}licenses/{name}", text.encode("utf-8")) for name, text in names.items()]
    write(Path(wheel), made, f"{about}RECORD")


def write(wheel, made, record):
    """Writes the wheel with a new list of its files."""
    rows = io.StringIO()
    table = csv.writer(rows, lineterminator="\n")
    unfinished = wheel.with_suffix(".unfinished")
    with zipfile.ZipFile(unfinished, "w", zipfile.ZIP_DEFLATED) as archive:
        for info, content in made:
            archive.writestr(info, content)
            name = getattr(info, "filename", info)
            if not name.endswith("/"):
                digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).decode()
                table.writerow([name, f"sha256={digest.rstrip('=')}", len(content)])
        table.writerow([record, "", ""])
        archive.writestr(record, rows.getvalue())
    os.replace(unfinished, wheel)


if __name__ == "__main__":
    for each in sys.argv[1:]:
        complete(each)
