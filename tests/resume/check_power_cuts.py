"""Cuts the power at any moment of a run: what was not synchronised with the disk may be lost, and the run goes on all the same.

usage: check_power_cuts.py ROULEAU SCENE [--cuts N] [--seed N]

One run is traced (strace): everything it does to its directory, in order. For each of N random moments a directory is made as
a disk may hold it after a power cut at that moment: of every file what was synchronised (fsync), and of the writes since then
all, none, the first few or any of them; of names (files made, renamed, removed) those that were synchronised with their
folder, and the first few since then. In each of them `rouleau run --resume` must come to the results of the run that nobody
disturbed. Ends with 77 where strace is missing or not allowed.
"""

import argparse
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from check_kills import differences

TRACED = "openat,creat,write,pwrite64,writev,pwritev,ftruncate,fsync,fdatasync,rename,renameat,unlink,unlinkat,mkdir,lseek,close,dup,dup2"


def text_of(hexadecimal):
    return bytes.fromhex(hexadecimal.replace("\\x", ""))


class File:
    """An inode: `held` is on the disk, `since` are the changes that no fsync has followed."""

    def __init__(self):
        self.held, self.since = bytearray(), []

    @staticmethod
    def applied(content, change):
        what, at, data = change
        if what == "truncate":
            del content[at:]
            content.extend(bytes(at - len(content)))
        else:
            content.extend(bytes(max(0, at - len(content))))
            content[at:at + len(data)] = data

    def size(self):
        content = bytearray(self.held)
        for change in self.since:
            self.applied(content, change)
        return len(content)

    def after_a_cut(self, chance):
        content = bytearray(self.held)
        kept = {0: lambda: self.since, 1: lambda: [], 2: lambda: self.since[:chance.randint(0, len(self.since))],
                3: lambda: [c for c in self.since if chance.random() < 0.5]}[chance.randrange(4)]()
        for change in kept:
            self.applied(content, change)
        return bytes(content)


class Disk:
    """What a traced run has done so far to the files of one folder."""

    def __init__(self, folder):
        self.folder = str(folder)
        self.names, self.held, self.since = {}, {}, []  # name -> File: now; on the disk; changes of names since
        self.open = {}  # descriptor -> [File, offset, append]; of the folder itself: None

    def named(self, path):
        path = os.path.normpath(path)
        return os.path.basename(path) if os.path.dirname(path) == self.folder else None

    def rename(self, change):
        name, file = change
        if file is None:
            self.names.pop(name, None)
        else:
            self.names[name] = file
        self.since.append(change)

    def do(self, call, words, result):
        """One system call that succeeded. Returns whether it changed anything that a cut may lose or keep."""
        if call in ("openat", "creat"):
            path, flags = text_of(re.search(r'"((?:\\x[0-9a-f]{2})*)"', words)[1]).decode(), words
            self.open.pop(result, None)
            if os.path.normpath(path) == self.folder:
                self.open[result] = None
            name = self.named(path)
            if name is None:
                return False
            made = name not in self.names and "O_CREAT" in flags
            if made:
                self.rename((name, File()))
            if name in self.names:
                file = self.names[name]
                self.open[result] = [file, 0, "O_APPEND" in flags]
                if "O_TRUNC" in flags and file.size() > 0:
                    file.since.append(("truncate", 0, b""))
            return made
        if call in ("rename", "unlink"):
            names = [self.named(text_of(found).decode()) for found in re.findall(r'"((?:\\x[0-9a-f]{2})*)"', words)]
            if names[0] is None:
                return False
            file = self.names[names[0]]
            if call == "rename":
                # A rename is one change of both names.
                self.names.pop(names[0])
                self.names[names[1]] = file
                self.since.append((names[1], file, names[0]))
            else:
                self.rename((names[0], None))
            return True
        if call == "mkdir":
            return False
        number = int(re.match(r"\d+", words)[0])
        if number not in self.open:
            return False
        opened = self.open[number]
        if call == "close":
            del self.open[number]
            return False
        if call in ("fsync", "fdatasync"):
            if opened is None:
                self.apply_names(self.held, self.since)
                self.since = []
            else:
                for change in opened[0].since:
                    File.applied(opened[0].held, change)
                opened[0].since = []
            return True
        if opened is None:
            return False
        file = opened[0]
        if call == "lseek":
            opened[1] = result
            return False
        if call == "ftruncate":
            file.since.append(("truncate", int(words.split(",")[1]), b""))
        elif call in ("write", "pwrite64"):
            data = text_of(re.search(r'"((?:\\x[0-9a-f]{2})*)"', words)[1])[:result]
            at = int(words.rsplit(",", 1)[1]) if call == "pwrite64" else file.size() if opened[2] else opened[1]
            if call == "write":
                opened[1] = at + len(data)
            file.since.append(("write", at, data))
        else:
            sys.exit(f"{call} is not understood: {words[:80]}")
        return True

    @staticmethod
    def apply_names(names, changes):
        for change in changes:
            if len(change) == 3:
                names.pop(change[2], None)
            if change[1] is None:
                names.pop(change[0], None)
            else:
                names[change[0]] = change[1]

    def after_a_cut(self, chance, folder):
        """Writes what a disk may hold."""
        names = dict(self.held)
        self.apply_names(names, self.since[:chance.choice([0, len(self.since), chance.randint(0, len(self.since))])])
        folder.mkdir(parents=True)
        for name, file in names.items():
            (folder / name).write_bytes(file.after_a_cut(chance))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program", type=Path)
    parser.add_argument("scene", type=Path)
    parser.add_argument("--cuts", type=int, default=100)
    parser.add_argument("--seed", type=int, default=int.from_bytes(os.urandom(4), "little"))
    arguments = parser.parse_args()
    chance = random.Random(arguments.seed)
    with tempfile.TemporaryDirectory() as scratch:
        scratch = Path(os.path.realpath(scratch))
        whole, trace = scratch / "whole", scratch / "trace"

        def command(directory, *options):
            return [str(arguments.program.resolve()), "run", str(arguments.scene), "--out", str(directory), *options]

        tracer = ["strace", "-f", "-qq", "-xx", "-s", "100000000", "--signal=none", "-o", str(trace), f"--trace={TRACED}"]
        if shutil.which("strace") is None or subprocess.run([*tracer, "true"], capture_output=True).returncode != 0:
            print("skipped: no strace here, or it is not allowed")
            return 77
        subprocess.run([*tracer, *command(whole, "--threads", "1")], check=True, capture_output=True)
        calls = []
        for line in trace.read_text().splitlines():
            found = re.match(r"\d+ +(\w+)\((.*)\) += (\d+)(?:$| |<)", line, re.S)
            if found:
                calls.append((found[1], found[2], int(found[3])))
            elif "unfinished" in line:
                sys.exit("two threads write: " + line[:80])
        disk = Disk(whole)
        moments = [i for i, call in enumerate(calls) if disk.do(*call)]
        for name, file in disk.names.items():  # the model is right: it ends with the files that are there
            content = bytearray(file.held)
            for change in file.since:
                File.applied(content, change)
            assert content == (whole / name).read_bytes(), f"{name} is not what the traced calls made of it"
        cuts = sorted(chance.choice(moments) for _ in range(arguments.cuts))
        print(f"seed {arguments.seed}; {len(moments)} moments, {len(cuts)} cuts; "
              f"not synchronised at the end: {sorted(n for n, f in disk.names.items() if f.since)}", flush=True)
        disk, done, tasks = Disk(whole), 0, []
        for number, cut in enumerate(cuts):
            while done <= cut:
                disk.do(*calls[done])
                done += 1
            disk.after_a_cut(chance, scratch / f"cut-{number}")
            tasks.append((number, cut))

        def resume(task):
            directory = scratch / f"cut-{task[0]}"
            files = ", ".join(f"{f.name} {f.stat().st_size}" for f in sorted(directory.iterdir()))
            result = subprocess.run(command(directory, "--resume"), capture_output=True, text=True, timeout=300)
            wrong = [f"code {result.returncode}: {result.stderr}"] if result.returncode else differences(whole, directory)
            shutil.rmtree(directory)
            return task, files, wrong

        ended = Counter()
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            for (number, cut), files, wrong in pool.map(resume, tasks):
                ended["differently" if wrong else "as the run that nobody disturbed"] += 1
                if wrong:
                    call, words, _ = calls[cut]
                    print(f"cut {number} behind call {cut}, {call}({words[:60]}): {files}\n  " + "\n  ".join(wrong))
        print(f"went on and ended: {dict(ended)}")
    return 1 if ended["differently"] else 0


if __name__ == "__main__":
    sys.exit(main())
