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


def data_of(path):
    """What a page that was made shows."""
    with open(path, encoding="utf-8") as file:
        found = re.search(r'<script type="application/json" id="data">(.*?)</script>', file.read(), re.DOTALL)
    if not found:
        raise ValueError(f"{path}: is no page of cremed-report")
    return json.loads(found[1])
