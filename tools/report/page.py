# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""One file with all that the browser needs: nothing of it comes from elsewhere."""
import html
import json
import os
import pathlib
import re

DYGRAPHS = pathlib.Path("/usr/share/javascript/dygraphs")


def dygraphs(name, share):
    """Debian's file. Its licence, which it only points to, is put in place of the pointer."""
    try:
        text = (DYGRAPHS / name).read_text(encoding="utf-8")
    except FileNotFoundError as error:
        raise ValueError(f"{error.filename} is absent: install libjs-dygraphs") from error
    licence = (share / "view/dygraphs-licence.txt").read_text(encoding="utf-8")
    text = re.sub(r"/\*! @license .*?\*/", lambda _: f"/*\n{licence}*/", text)
    return re.sub(r"(//|/\*)# sourceMappingURL=\S*(\s*\*/)?", "", text)


def page(data, share):
    texts = {"dygraph.min.js": dygraphs("dygraph.min.js", share),
             "dygraph.min.css": dygraphs("dygraph.min.css", share),
             # In a script element "<" could end it.
             "data": json.dumps(data, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c"),
             "title": html.escape(", ".join(data["logs"]))}
    for name in ("view/charts.js", "view/style.css", "report/report.js"):
        texts[os.path.basename(name)] = (share / name).read_text(encoding="utf-8")
    template = (share / "report/report.html").read_text(encoding="utf-8")
    return re.sub(r"\{\{(.*?)\}\}", lambda match: texts[match[1]], template)


def index(drives):
    rows = "".join(
        f'<tr><td><a href="{html.escape(os.path.basename(drive.page))}">{html.escape(drive.logs[0])}</a>'
        f'<td>{drive.figures["duration_s"]:.1f}<td>{drive.figures["path_length_m"]:.0f}'
        f'<td>{html.escape(", ".join(in_doubt(drive.figures)) or "none")}' for drive in drives)
    return ('<!DOCTYPE html><html lang="en"><meta charset="utf-8"><title>cremed: drives</title>'
            '<style>body{font:15px sans-serif;margin:2em}td,th{padding:.2em 1em;text-align:left}</style>'
            f'<h1>{len(drives)} drives</h1><table><tr><th>drive<th>s<th>m<th>radars in doubt{rows}</table>')


def in_doubt(figures):
    return [radar for radar, told in figures["radars"].items() if told["statuses_with_doubt"]]
