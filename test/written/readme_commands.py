# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""The command lines of the READMEs as a reader copies them."""
import os
import pathlib
import re
from dataclasses import dataclass

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Programs of others; the project's are recognised by name and path.
OTHERS = {"apt-get", "candump", "cmake", "cp", "cpack", "ctest", "evo_ape", "find", "install", "ip", "journalctl",
          "lcm-logger", "sbatch", "systemctl", "systemd-analyze"}


@dataclass(frozen=True)
class Command:
    document: str
    heading: str
    text: str  # In one line, without comment.
    options_only: bool = False  # "--speed 1": part of a command line.

    def words(self):
        return self.text.split()


def documents():
    return [path for path in sorted(ROOT.rglob("*.md"))
            if "build" not in path.relative_to(ROOT).parts[0]]


def is_program(word):
    return (word in OTHERS or re.fullmatch(r"cremed(-[a-z-]+)?", word) is not None
            or ("/" in word and os.access(ROOT / word, os.X_OK) and (ROOT / word).is_file()))


def is_command(text):
    words = text.split()
    return bool(words) and is_program(words[1] if words[0] == "sudo" and words[1:] else words[0])


def plain(line):
    """A line of a code block without prompt and comment."""
    return " ".join(re.sub(r"(^|\s)#\s.*", "", line.strip()).removeprefix("$ ").split())


def blocks(text):
    """Lines of fenced and of indented code blocks."""
    fenced = False
    for line in text.splitlines():
        if line.lstrip().startswith("```"):
            fenced = not fenced
        elif fenced or line.startswith("    "):
            yield line


def prose(text):
    return "\n".join(line for line in text.splitlines() if not line.startswith("    "))


def commands_in(document, heading, text):
    for line in blocks(text):
        if is_command(plain(line)):
            yield Command(document, heading, plain(line))
    for span in re.findall(r"`([^`]+)`", prose(text)):
        span = " ".join(span.split())
        if is_command(span) or span.startswith("--"):
            yield Command(document, heading, span, span.startswith("--"))


def all_commands():
    """[Command] of all documents in order, each once per heading."""
    found = {}
    for path in documents():
        parts = re.split(r"^#+ (.*)$", path.read_text(encoding="utf-8"), flags=re.MULTILINE)
        for heading, text in zip(parts[1::2], parts[2::2]):
            for command in commands_in(str(path.relative_to(ROOT)), heading, text):
                found.setdefault(command)
    return list(found)


def other_lines():
    """Lines of code blocks that are not command lines."""
    return [plain(line) for path in documents() for line in blocks(path.read_text(encoding="utf-8"))
            if plain(line) and not is_command(plain(line))]


def vehicle_steps():
    """The numbered steps only: examples follow them."""
    document, heading = "systemd/README.md", "On your vehicle"
    text = (ROOT / document).read_text(encoding="utf-8")
    section = text.split(f"## {heading}\n")[1].split("\n\n")[0]
    return [command for command in commands_in(document, heading, section)
            if not command.options_only]
