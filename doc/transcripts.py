#!/usr/bin/env python3
"""Runs what the manual shows, and compares or renews what it prints.

    transcripts.py [--write] [--jobs N] PROGRAM CHAPTER.md ...

In a chapter, in the order of the text, in a fresh folder, by sh with steif first on PATH:
  - a fenced block after a line "`name`:" is written as the file `name`;
  - in a ```console block, lines "$ command" are run, and what follows is their output, standard error included;
    a code that is not 0 is the last line, "[exit 3]";
  - a ```python block is run by this interpreter, if it has SciPy where that is imported, and the ```text block after it
    is its output;
  - tables between "<!-- options VERB -->" and "<!-- end -->" are those of `steif VERB --help`.

Without --write every block is compared. Texts must be equal, line breaks and distances apart. Numbers must
agree to 3 digits; whole numbers must be equal. By the word that stands before a line or over a column:
counts of a run within a third, digits within 2, which is what the rounding of another processor moves them by
where errors cancel, orders within 0.1 ("order 2.01"; 1 over a column), times of the clock and sizes of errors not at
all; numbers below 1e-10 are sizes of rounding errors, too. To how many digits two runs agree ("reference") is rounding
as soon as they are good: within 3. Rows of SUNDIALS' engines are those of the SUNDIALS installed: counts and digits are
not compared.
"""
import argparse
import concurrent.futures
import os
import re
import subprocess
import sys
import tempfile
from importlib.util import find_spec

NUMBER = re.compile(r"(?<![A-Za-z_0-9.])[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?![A-Za-z_0-9])")
IGNORED = re.compile(r"(cpu_s|seconds|rounding|estimate|residual\S*|gap|rcond|K_cond|spread|price|per_step"
                     r"|hidden_error|\S*corrected|\S*accuracy|lte_\w+|tau_max|tolerance|K|P|drift|distance"
                     r"|K_distance)$")
ENGINE = re.compile(r"(cvodes?|idas?|arkode)(:|$)")
COUNTS = re.compile(r"(stats\.\w+|steps|rejected|nfe|nje|nlu|nsolve|newton|nli|triggers|redone|operations)$")
DIGITS = re.compile(r"(scd|mescd|digits|order( of)?|cosine|reference)$")
WITHIN = {"scd": 2, "mescd": 2, "digits": 2, "reference": 3, "order of": 0.1}  # 1 for the others


COMMON = ("--json", "--csv", "--plot", "--quiet", "--help")  # explained once in the manual


def fences(text):
    """(first line, last line, info, title) of every fenced block; title: of a line "`title`:" before it."""
    lines, start, title = text.split("\n"), None, ""
    for i, line in enumerate(lines):
        if start is None and line.startswith("```"):
            start, info = i, line[3:].strip()
        elif start is not None and line == "```":
            yield start, i, info, title
            start, title = None, ""
        elif start is None and line.strip():
            named = re.match(r"`([^`]+)`:$", line)
            title = named.group(1) if named else ""


# ---- running ----------------------------------------------------------------------------------------------

def run(command, folder, path):
    """The output of a command of the shell, with its exit code when it is not 0."""
    environment = dict(os.environ, PATH=path + os.pathsep + os.environ["PATH"], COLUMNS="100")
    done = subprocess.run(command, cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=300)
    text = done.stdout.rstrip("\n")
    lines = [line.rstrip() for line in text.split("\n")] if text else []
    return lines + ["[exit %d]" % done.returncode] * (done.returncode != 0)


def console(lines, folder, path):
    """The commands of a block, each followed by its output."""
    shown = []
    for line in lines:
        if line.startswith("$ "):
            shown += [line] + [text for text in run(["sh", "-c", line[2:]], folder, path)]
    while shown and not shown[-1]:
        shown.pop()
    return shown


def options(verb, folder, path):
    """The table of options of `steif VERB --help`: name, meaning, default."""
    out, rows = run(["steif", verb, "--help"], folder, path), []
    for line in out[3:]:
        if line.startswith("  --"):
            name, _, about = line[2:].partition("  ") if "  " in line[2:] else (line[2:], "", "")
            if len(name) > 28:
                match = re.match(r"(--\S+ \S+) (.*)", name)
                name, about = match.groups() if match else (name, about)
            rows.append([name, about.strip()])
        elif rows and line.startswith("      ") and not rows[-1][1]:
            rows[-1][1] = line.strip()
        elif rows:
            break
    own = [row for row in rows if row[0].split()[0] not in COMMON]
    if not own:
        return ["No options of its own."]
    table = ["| option | meaning | default |", "| --- | --- | --- |"]
    for name, about in own:
        found = re.match(r"(.*?) \(default:? (.*)\)$", about)
        about, default = found.groups() if found else (about, "")
        cells = ("`%s`" % name, about, default)
        table.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return table


# ---- comparing --------------------------------------------------------------------------------------------

def labelled(lines):
    """The text as a list of words and (number, label); the label is the key of the line or the column."""
    pieces, key, header, blank = [], "", [], False
    for line in lines:
        words = line.split()
        known = re.match(r"([A-Za-z_][\w.-]*)  +\S", line)
        if not words:
            key, header, blank = "", [], True
            continue
        numbers = [w for w in words if NUMBER.fullmatch(w) or w in ("-", "nan", "inf")]
        if blank and len(words) > 1 and not numbers:
            header = words  # perhaps: a row of as many words has these labels
        blank = blank and len(words) == 1  # the title of a table
        row = len(words) == len(header) and numbers
        if known and not row:
            key = known.group(1)
        elif not line.startswith("  "):
            key = ""
        for i, word in enumerate(words):
            label, at = header[i] if row else key, 0
            if row and ENGINE.match(words[0]) and (COUNTS.match(label) or DIGITS.match(label)):
                label = "cpu_s"
            if i and words[i - 1] == "order" and not row:
                label = "order of"
            for match in NUMBER.finditer(word):
                pieces += [word[at:match.start()]] if match.start() > at else []
                pieces.append((match.group(), label))
                at = match.end()
            pieces += [word[at:]] if at < len(word) else []
    return pieces


def close(a, b, label):
    x, y = float(a), float(b)
    if a == b or IGNORED.match(label) or max(abs(x), abs(y)) < 1e-10:
        return True
    if COUNTS.match(label):
        return abs(x - y) <= max(abs(x), abs(y)) / 3 + 2
    if DIGITS.match(label):
        return abs(x - y) <= WITHIN.get(label, 1)
    if re.fullmatch(r"[-+]?\d+", a) and re.fullmatch(r"[-+]?\d+", b) and abs(x) < 1e6:
        return False
    return abs(x - y) <= 2e-3 * max(abs(x), abs(y))


def difference(shown, printed):
    """None, or where the first difference is."""
    left, right = labelled(shown), labelled(printed)
    for i in range(max(len(left), len(right))):
        a, b = (side[i] if i < len(side) else "the end" for side in (left, right))
        if isinstance(a, tuple) and isinstance(b, tuple):
            if close(a[0], b[0], a[1]):
                continue
            return "%s %s is printed as %s" % (a[1] or "the number", a[0], b[0])
        if a != b:
            return "shown %r, printed %r" % (a, b)
    return None


# ---- chapters ---------------------------------------------------------------------------------------------

def lacking(body):
    """Does a program use SciPy where there is none? It is left out there."""
    return any(re.match(r"(import|from) scipy\b", line) for line in body) and not find_spec("scipy")


def renewed(lines, blocks, path):
    """(first, last, old, new) of all that is run, in order."""
    with tempfile.TemporaryDirectory() as folder:
        for k, (first, last, info, title) in enumerate(blocks):
            body = lines[first + 1:last]
            if title:
                with open(os.path.join(folder, title), "w", encoding="utf-8") as file:
                    file.write("\n".join(body) + "\n")
            elif info == "console":
                yield first + 1, last, body, console(body, folder, path)
            elif info == "python" and not lacking(body):
                printed = run([sys.executable, "-c", "\n".join(body)], folder, path)
                if k + 1 < len(blocks) and blocks[k + 1][2] == "text":
                    a, b = blocks[k + 1][:2]
                    yield a + 1, b, lines[a + 1:b], printed
                elif printed:
                    yield last + 1, last + 1, [], ["", "```text"] + printed + ["```"]
        for i, line in enumerate(lines):
            wanted = re.match(r"<!-- options (\w+) -->$", line)
            if wanted:
                end = lines.index("<!-- end -->", i)
                yield i + 1, end, lines[i + 1:end], [""] + options(wanted.group(1), folder, path) + [""]


def chapter(name, path, write):
    """What is wrong in a chapter; with `write` it is renewed instead."""
    with open(name, encoding="utf-8") as file:
        text = file.read()
    lines, wrong, changed = text.split("\n"), [], []
    for first, last, old, new in renewed(lines, list(fences(text)), path):
        where = difference(old, new)
        if where:
            wrong.append("%s:%d: %s; after '%s'" % (name, first + 1, where, lines[first]))
            changed.append((first, last, new))
    if write and changed:
        for first, last, new in sorted(changed, reverse=True):
            lines[first:last] = new
        with open(name, "w", encoding="utf-8") as file:
            file.write("\n".join(lines))
        return ["%s: %d blocks renewed" % (name, len(changed))]
    return wrong


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("program")
    parser.add_argument("chapter", nargs="+")
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        os.symlink(os.path.abspath(asked.program), os.path.join(folder, "steif"))
        with concurrent.futures.ThreadPoolExecutor(asked.jobs) as pool:
            said = list(pool.map(lambda name: chapter(name, folder, asked.write), asked.chapter))
    said = [sentence for one in said for sentence in one]
    print("\n".join(said) or "%d chapters as printed" % len(asked.chapter))
    return 0 if asked.write or not said else 1


if __name__ == "__main__":
    sys.exit(main())
