#!/usr/bin/env python3
"""Does a test notice when the code is wrong? Each row of list.txt is a mutation: the tests to run, separated
by |, a file, a text that occurs in it once, and the wrong text instead, separated by tabulators. Every mutation
is made alone in a copy of the tree, built and tested; it is killed when it does not compile, when a test fails,
or when a test takes more than ten times the processor time that it takes on the right tree. A test that is
not at its end after an hour of waiting decides nothing; it is said and counted apart.

    run.py [--only N,N-N,...] [--jobs N] FOLDER      FOLDER: for the copy and its build, kept for the next run

The exit code is the number of mutations not killed, at most 100. All of them take hours on two cores.
"""
import argparse
import os
import resource
import shutil
import signal
import subprocess
import sys
import threading

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
TIMES, LEAST, WAIT = 10, 60, 3600  # of the processor time of the right tree; seconds of it, and of patience


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
    targets = [f"test_{name}" for name in tests]
    return run(["cmake", "--build", "tree/build", "-j", str(jobs), "--target", *targets], folder)


def tested(folder, name, limit):
    """One test, ended at its first failure: "passed", "failed", "endless" or "late"; and its processor time."""

    def bounded():
        resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 5))
        resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))

    test = subprocess.Popen(["stdbuf", "-oL", f"./test_{name}"], cwd=os.path.join(folder, "tree", "build"),
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, preexec_fn=bounded)
    late = threading.Timer(WAIT, os.kill, (test.pid, signal.SIGKILL))  # Popen.kill would reap it
    late.start()
    failed = False
    for line in test.stdout:
        failed = failed or b"had failures" in line
        if failed:
            os.kill(test.pid, signal.SIGKILL)
            break
    test.stdout.close()
    _, status, used = os.wait4(test.pid, 0)
    test.returncode = os.waitstatus_to_exitcode(status)
    out_of_time = not late.is_alive()
    late.cancel()
    seconds = used.ru_utime + used.ru_stime
    if failed:
        return "failed", seconds
    if test.returncode == -signal.SIGXCPU or seconds >= limit:
        return "endless", seconds
    if out_of_time:
        return "late", seconds
    return "failed" if test.returncode else "passed", seconds


class Right:
    """The processor time of each test on the right tree, where it must pass."""

    def __init__(self, folder, jobs):
        self.folder, self.jobs, self.seconds = folder, jobs, {}

    def measure(self, tests):
        missing = [name for name in tests if name not in self.seconds]
        if missing:
            built = build(self.folder, missing, self.jobs)
            if built.returncode:
                sys.exit(built.stdout[-4000:] + "\nthe tree does not build without a mutation")
        for name in missing:
            said, self.seconds[name] = tested(self.folder, name, WAIT)
            if said != "passed":
                sys.exit(f"{name} does not pass without a mutation: {said}")


def judge(folder, jobs, right, tests):
    if build(folder, tests, jobs).returncode:
        return "killed by the compiler"
    late = []
    for name in sorted(tests, key=right.seconds.get):
        said, _ = tested(folder, name, LEAST + int(TIMES * right.seconds[name]))
        if said == "failed":
            return f"killed by {name}"
        if said == "endless":
            return f"killed by {name}: more than {TIMES} times its processor time"
        if said == "late":
            late.append(name)
    return f"not decided: {', '.join(late)} did not end" if late else "SURVIVED"


def mutate(folder, tree, jobs, right, row):
    tests, name, correct, wrong = row
    tests = tests.split("|")
    path = os.path.join(tree, name)
    if not os.path.isfile(path):
        return f"not made: there is no {name}"
    with open(path, encoding="utf-8") as text:
        whole = text.read()
    if whole.count(correct) != 1:
        return f"not made: its text occurs {whole.count(correct)} times in {name}"
    right.measure(tests)
    with open(path, "w", encoding="utf-8") as text:
        text.write(whole.replace(correct, wrong))
    try:
        return judge(folder, jobs, right, tests)
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
    if first.returncode:
        sys.exit(first.stdout[-4000:])
    right = Right(given.folder, given.jobs)
    counts = {"killed": 0, "SURVIVED": 0, "not": 0}
    for k in chosen(given.only, len(all_rows)):
        said = mutate(given.folder, tree, given.jobs, right, all_rows[k - 1])
        counts[said.split()[0]] += 1
        print(f"{k:3}  {all_rows[k - 1][1]}: {all_rows[k - 1][2][:60]}\n     {said}", flush=True)
    made = counts["killed"] + counts["SURVIVED"]
    print(f"{counts['killed']} of {made} killed, {counts['SURVIVED']} survived, {counts['not']} not made or not decided")
    sys.exit(min(100, counts["SURVIVED"] + counts["not"]))


if __name__ == "__main__":
    main()
