# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""The page that lists several drives, those that need a look first."""
import html
import os
import urllib.parse
from dataclasses import dataclass

COLUMNS = ("drive", "errors", "warnings", "duration [s]", "path [m]", "odometry usable [% of the time]", "seconds in doubt",
           "position after 10 s [% of the path]", "yaw [\u00b0]", "what is wrong first")
# A click on a column's name sorts by it, another the other way round. What is not known comes last.
SORT = """
document.querySelectorAll("th").forEach((head, column) => head.addEventListener("click", () => {
  const body = document.querySelector("tbody"), down = head.dataset.down !== "yes";
  document.querySelectorAll("th").forEach((other) => delete other.dataset.down);
  if (down) head.dataset.down = "yes";
  const value = (row) => row.cells[column].dataset.value;
  body.append(...[...body.rows].sort((a, b) => {
    const [x, y] = [value(a), value(b)];
    if (x === "" || y === "") return (x === "") - (y === "");
    return (isNaN(x) || isNaN(y) ? x.localeCompare(y) : x - y) * (down ? -1 : 1);
  }));
}));
"""


def after_10_s(figures):
    """(position in % of the path, yaw in degrees) of the odometry against truth, or Nones."""
    for one in figures or ():
        for segment in one["segments"] if one["source"] == "odometry" else ():
            if segment["after"] == "10 s" and segment["segments"]:
                return segment["position_percent"], segment["rmse_m_m_rad"][2] * 57.29577951308232
    return None, None


def first_error(text):
    lines = text.splitlines()
    return next((line for line in lines if line.startswith("error: ")), lines[-1]).removeprefix("error: ")


@dataclass
class Row:
    log: str
    failure: str = ""
    page: str = ""
    numbers: tuple = (None,) * 6  # From the duration on.
    errors: int = 1
    warnings: int = 0
    first: str = ""

    @classmethod
    def of(cls, drive):
        figures, found = drive.figures, drive.findings
        doubts = max((radar["statuses_in_doubt"] for radar in figures["radars"].values()), default=0)
        odometry = figures["odometry"]
        numbers = (figures["duration_s"], figures["path_length_m"] if odometry else None,
                   odometry["availability_percent"] if odometry else None, doubts, *after_10_s(drive.truth_figures))
        count = {name: sum(one["severity"] == name for one in found) for name in ("error", "warning")}
        return cls(drive.logs[0], "", os.path.basename(drive.page), numbers, count["error"], count["warning"],
                   found[0]["what"] if found else "")

    def cells(self):
        """(shown, what it sorts by)"""
        name = html.escape(self.log)
        address = urllib.parse.quote(os.fsencode(self.page))
        yield f'<a href="{address}">{name}</a>' if self.page else name, name
        yield str(self.errors), self.errors
        yield str(self.warnings), self.warnings
        for value, digits in zip(self.numbers, (1, 0, 1, 0, 2, 2)):
            yield ("\u2013", "") if value is None else (f"{value:.{digits}f}", value)
        first = html.escape(first_error(self.failure) if self.failure else self.first)
        yield first, first

    def html(self):
        kind = "bad" if self.failure or self.errors else "careful" if self.warnings else ""
        cells = "".join(f'<td data-label="{label}" data-value="{value}">{shown}'
                        for label, (shown, value) in zip(COLUMNS, self.cells()))
        return f'<tr class="{kind}">{cells}'


def index(rows, share):
    rows = sorted(rows, key=lambda row: (-bool(row.failure), -row.errors, -row.warnings, row.log))
    style = (share / "view/style.css").read_text(encoding="utf-8")
    wrong = sum(bool(row.failure or row.errors) for row in rows)
    heads = "".join(f"<th>{name}" for name in COLUMNS)
    return ('<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><meta name="viewport" '
            'content="width=device-width, initial-scale=1"><title>cremed: drives</title>'
            f'<style>{style}</style></head><body><h1>{len(rows)} drives, {wrong} with errors</h1>'
            '<p class="muted">A click on the name of a column sorts by it.</p>'
            f'<section><table class="index"><thead><tr>{heads}</thead>'
            f'<tbody>{"".join(row.html() for row in rows)}</tbody></table></section>'
            f'<script>{SORT}</script></body></html>')
