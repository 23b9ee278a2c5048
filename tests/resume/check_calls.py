"""Lets every system call and every allocation of a small run fail, one at a time.

usage: check_calls.py ROULEAU FAILING_ALLOCATION SCENE [--seconds S] [--seed N] [--only NAME[:N]]

A run whose one call failed must end in one of two ways. With code 0 it has done without, and its results are those of a run
that nobody disturbed. Otherwise it says in a sentence what failed, ends with a code that means something, and goes on with
--resume to the same results. System calls fail under strace, with each error in turn that its kind may have; allocations
under FAILING_ALLOCATION (failing_allocation.c), one for each place in the program that asks for memory, with 2 threads.
With --seconds a random part of them is tried, the number of which is said; without, all are. Ends with 77 where strace is
missing or not allowed.
"""

import argparse
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter, defaultdict
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from check_kills import MEASURED, differences

MEASURED.append("machine")  # its processor's name comes from /proc, which may fail to be read

# What a call may fail with, after the manual pages; brk returns a number that is too small. Calls that cannot fail are left
# out.
ERRORS = {
    "openat": ["EMFILE", "EIO"], "read": ["EIO"], "pread64": ["EIO"], "write": ["ENOSPC", "EIO"], "pwrite64": ["ENOSPC"],
    "close": ["EIO"], "fsync": ["EIO"], "rename": ["EACCES"], "ftruncate": ["ENOSPC"], "mkdir": ["EACCES"],
    "unlink": ["EACCES"], "mmap": ["ENOMEM"], "mprotect": ["ENOMEM"], "brk": ["0"], "lseek": ["EIO"],
    "newfstatat": ["EACCES"], "fstat": ["EIO"], "flock": ["ENOLCK"], "fcntl": ["ENOLCK"], "getdents64": ["EIO"],
    "getcwd": ["ENOENT"], "readlink": ["EACCES"], "sigaltstack": ["ENOMEM"], "memfd_create": ["EMFILE"],
    "clone3": ["EAGAIN"], "dup2": ["EMFILE"], "dup": ["EMFILE"], "ioctl": ["EIO"], "sysinfo": ["EFAULT"],
    "uname": ["EFAULT"], "getrandom": ["ENOSYS"], "sched_getaffinity": ["EINVAL"], "prlimit64": ["EPERM"],
    "statx": ["EACCES"], "access": ["EACCES"], "copy_file_range": ["EIO"], "sendfile": ["EIO"], "getrusage": ["EFAULT"],
    "ftruncate64": ["ENOSPC"], "fadvise64": ["EINVAL"],
}
CODES = {2, 3, 4}  # of what the user gave, of a plugin, of a file or the machine


class Small_run:
    def __init__(self, program, allocation, scene, folder):
        self.program, self.allocation, self.scene, self.folder = program, allocation, scene, folder
        self.left_alone = folder / "left-alone"
        result = self.run(self.left_alone)
        assert result.returncode == 0, result.stderr

    def command(self, directory, *options):
        return [str(self.program), "run", str(self.scene), "--out", str(directory), *options]

    def run(self, directory, *options, before=(), **environment):
        return subprocess.run([*before, *self.command(directory, *options)], capture_output=True, text=True,
                              errors="replace", timeout=120, env=dict(os.environ, **environment))

    def calls(self):
        """How often each system call is made: before main, and in all."""
        trace = self.folder / "trace"
        result = self.run(self.folder / "traced", before=["strace", "-f", "-qq", "-o", str(trace)])
        if result.returncode != 0:
            return None
        early, total, begun = Counter(), Counter(), False
        for line in trace.read_text(errors="replace").splitlines():
            found = re.match(r"\d+ +(\w+)\(", line)
            if not found:
                continue
            begun = begun or found[1] == "sigaltstack"  # the program's first call of its own
            total[found[1]] += 1
            early[found[1]] += not begun
        return {name: (early[name], total[name]) for name in total}

    def places(self):
        """The requests for memory that differ in who asks."""
        listed = self.folder / "places"
        self.run(self.folder / "allocation-000000", "--threads", "2", LD_PRELOAD=str(self.allocation), FAILING_ALLOCATION="0",
                 ALLOCATION_PLACES=str(listed))
        return [int(line) for line in listed.read_text().split()]

    def judged(self, directory, result):
        """How a disturbed run ended, and what is wrong with that: nothing, or a text."""
        code = result.returncode
        if code == 0:
            return "did without", "\n".join(differences(self.left_alone, directory))
        if "it has crashed" in result.stderr:
            how = "crashed and said so"
        else:
            how = f"code {code}"
        if code not in CODES:
            return f"code {code}", f"ended with {code}\n{result.stdout}{result.stderr}"
        if not result.stderr.strip() or "internal error" in result.stderr and "it has crashed" not in result.stderr:
            return f"code {code}", f"said: {result.stderr}"
        resumed = self.run(directory, "--resume")
        if resumed.returncode != 0:
            return how, f"said: {result.stderr}and --resume ended with {resumed.returncode}: {resumed.stderr}"
        return how, "\n".join(differences(self.left_alone, directory))

    def try_call(self, name, number, error):
        directory = self.folder / f"{name}-{number:06}-{error}"
        result = self.run(directory, before=["strace", "-f", "-qq", "-o", "/dev/null", f"--trace={name}", "--signal=none",
                                             f"--inject={name}:{'retval' if error.isdigit() else 'error'}={error}:when={number}"])
        return self.finish(directory, result)

    def try_allocation(self, number):
        directory = self.folder / f"allocation-{number:06}"
        result = self.run(directory, "--threads", "2", LD_PRELOAD=str(self.allocation), FAILING_ALLOCATION=str(number))
        return self.finish(directory, result)

    def finish(self, directory, result):
        try:
            how, wrong = self.judged(directory, result)
        except Exception as problem:  # a run that left nothing to compare
            how, wrong = f"code {result.returncode}", f"{problem}\n{result.stderr}"
        shutil.rmtree(directory, ignore_errors=True)
        return how, wrong


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program", type=Path)
    parser.add_argument("allocation", type=Path)
    parser.add_argument("scene", type=Path)
    parser.add_argument("--seconds", type=float, default=float("inf"))
    parser.add_argument("--seed", type=int, default=int.from_bytes(os.urandom(4), "little"))
    parser.add_argument("--only", default="")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        run = Small_run(arguments.program.resolve(), arguments.allocation.resolve(), arguments.scene.resolve(), Path(folder))
        if shutil.which("strace") is None or (calls := run.calls()) is None:
            print("skipped: no strace here, or it is not allowed")
            return 77
        places = run.places()
        trials = [("allocation", number) for number in places]
        trials += [(name, number, error) for name, (early, total) in calls.items() for error in ERRORS.get(name, [])
                   for number in range(early + 1, total + 1)]
        name, _, number = arguments.only.partition(":")
        trials = [t for t in trials if arguments.only in ("", t[0]) or (t[0] == name and str(t[1]) == number)]
        random.Random(arguments.seed).shuffle(trials)
        print(f"seed {arguments.seed}; {len(trials)} calls and allocations; not tried: "
              + ", ".join(sorted(set(calls) - set(ERRORS))), flush=True)
        end = time.monotonic() + arguments.seconds
        ways, failures = defaultdict(Counter), 0

        def attempt(trial):
            if time.monotonic() > end:
                return trial, None
            return trial, run.try_allocation(trial[1]) if trial[0] == "allocation" else run.try_call(*trial)

        with ThreadPoolExecutor(os.cpu_count()) as pool:
            for trial, outcome in pool.map(attempt, trials):
                if outcome is None:
                    continue
                how, wrong = outcome
                ways[trial[0]][how] += 1
                if wrong:
                    failures += 1
                    print(" ".join(map(str, trial)) + f": {wrong}", flush=True)
        for name in sorted(ways):
            print(f"{name:20} {sum(ways[name].values()):5} tried: "
                  + ", ".join(f"{how} {count}" for how, count in sorted(ways[name].items())))
        print(f"{sum(sum(w.values()) for w in ways.values())} of {len(trials)} tried, {failures} ended badly")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
