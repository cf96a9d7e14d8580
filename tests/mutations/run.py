#!/usr/bin/env python3
"""Does a test notice when the code is wrong? Each row of list.txt is a mutation: the tests to run as a
regular expression of ctest, a file, a text that occurs in it once, and the wrong text instead, separated by
tabulators. Every mutation is made alone in a copy of the tree, built and tested; it is killed when it does
not compile or a test fails, else it has survived.

    run.py [--only N,N-N,...] [--jobs N] FOLDER      FOLDER: for the copy and its build, kept for the next run

The exit code is the number of survivors, at most 100. All of them take hours on two cores.
"""
import argparse
import os
import shutil
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))


def rows():
    with open(os.path.join(HERE, "list.txt"), encoding="utf-8") as text:
        return [line.rstrip("\n").split("\t") for line in text if line.strip()]


def chosen(text, count):
    numbers = []
    for part in (text or f"1-{count}").split(","):
        first, _, last = part.partition("-")
        numbers += range(int(first), int(last or first) + 1)
    return [k for k in numbers if 1 <= k <= count]


def run(command, folder):
    return subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def copy(folder):
    """The tree as it is, so that times of files that are the same stay."""
    tree = os.path.join(folder, "tree")
    for name in ("lib", "include", "drivers", "tests", "cmake", "examples", "python", "doc"):
        source, target = os.path.join(ROOT, name), os.path.join(tree, name)
        if os.path.isdir(source):
            shutil.copytree(source, target, dirs_exist_ok=True, copy_function=renew)
    for name in ("CMakeLists.txt", "README.md", "CHANGELOG.md", "LICENSE", "CITATION.cff", "CONTRIBUTING.md"):
        renew(os.path.join(ROOT, name), os.path.join(tree, name))
    return tree


def renew(source, target):
    if os.path.exists(target):
        with open(source, "rb") as a, open(target, "rb") as b:
            if a.read() == b.read():
                return target
    return shutil.copy(source, target)


def build(folder, tests, jobs):
    targets = [f"test_{name}" for name in tests.split("|")]
    return run(["cmake", "--build", "tree/build", "-j", str(jobs), "--target", *targets], folder)


def judge(folder, jobs, tests):
    if build(folder, tests, jobs).returncode:
        return "killed by the compiler"
    command = ["ctest", "-R", f"^({tests})$", "-j", str(jobs), "--timeout", "300", "--stop-on-failure"]
    tested = run(command, os.path.join(folder, "tree", "build"))
    failed = [line.split(" - ")[1].split()[0] for line in tested.stdout.splitlines() if " - " in line]
    slow = "  (time was up)" if "***Timeout" in tested.stdout else ""
    return f"killed by {', '.join(failed)}{slow}" if tested.returncode else "SURVIVED"


def mutate(folder, tree, jobs, row):
    tests, name, right, wrong = row
    path = os.path.join(tree, name)
    with open(path, encoding="utf-8") as text:
        whole = text.read()
    if whole.count(right) != 1:
        return f"not made: its text occurs {whole.count(right)} times in {name}"
    with open(path, "w", encoding="utf-8") as text:
        text.write(whole.replace(right, wrong))
    try:
        return judge(folder, jobs, tests)
    finally:
        with open(path, "w", encoding="utf-8") as text:
            text.write(whole)


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    options.add_argument("--only")
    options.add_argument("--jobs", type=int, default=os.cpu_count())
    options.add_argument("folder")
    given = options.parse_args()
    given.folder = os.path.abspath(given.folder)
    os.makedirs(given.folder, exist_ok=True)
    tree = copy(given.folder)
    all_rows = rows()
    first = run(["cmake", "-S", tree, "-B", os.path.join(tree, "build")], given.folder)
    if first.returncode == 0:
        first = build(given.folder, "|".join({row[0] for row in all_rows}), given.jobs)
    if first.returncode:
        sys.exit(first.stdout[-4000:] + "\nthe tree does not build without a mutation")
    counts = {"killed": 0, "SURVIVED": 0, "not": 0}
    for k in chosen(given.only, len(all_rows)):
        said = mutate(given.folder, tree, given.jobs, all_rows[k - 1])
        counts[said.split()[0]] += 1
        print(f"{k:3}  {all_rows[k - 1][1]}: {all_rows[k - 1][2][:60]}\n     {said}", flush=True)
    made = counts["killed"] + counts["SURVIVED"]
    print(f"{counts['killed']} of {made} killed, {counts['SURVIVED']} survived, {counts['not']} not made")
    sys.exit(min(100, counts["SURVIVED"] + counts["not"]))


if __name__ == "__main__":
    main()
