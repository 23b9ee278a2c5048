"""What fails around a run: disks, files, terminals, clocks, other runs. Nothing may be lost but work since the last
checkpoint, and every message must say what to do. Python's standard library only.

usage: check_faults.py ROULEAU PLUGIN_FOLDER SCENE JUMPING_CLOCK
"""

import json
import os
import pty
import random
import resource
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

from check_kills import TABLES, summary

PROGRAM, PLUGINS, SCENE, JUMPING_CLOCK = (Path(a).resolve() for a in sys.argv[1:5])
SEED = int.from_bytes(os.urandom(4), "little")
CHANCE = random.Random(SEED)
FOLDER = tempfile.TemporaryDirectory()
LEFT_ALONE, STOPPED = Path(FOLDER.name) / "left-alone", Path(FOLDER.name) / "stopped"


def command(directory, *options, program=PROGRAM):
    return [str(program), "run", str(SCENE), "--out", str(directory), "--quiet", *map(str, options)]


def run(directory, *options, program=PROGRAM, **settings):
    return subprocess.run(command(directory, *options, program=program), capture_output=True, text=True, timeout=300,
                          **settings)


def installation(folder):
    """A copy of the program and its plugins that a test may damage: the two paths."""
    shutil.copytree(PLUGINS, folder / "lib" / "rouleau" / "plugins")
    (folder / "bin").mkdir()
    shutil.copy(PROGRAM, folder / "bin" / "rouleau")
    return folder / "bin" / "rouleau", folder / "lib" / "rouleau" / "plugins"


def setUpModule():
    """One run from beginning to end, and one that was killed after its second checkpoint."""
    print(f"seed {SEED}", flush=True)
    result = run(LEFT_ALONE)
    assert result.returncode == 0, result.stderr
    wanted = [STOPPED / name for name in ("checkpoint.h5", "checkpoint-previous.h5", "frames-0002.h5")]
    while not all(file.exists() for file in wanted):  # a kill may fall between the renames of two checkpoints
        shutil.rmtree(STOPPED, ignore_errors=True)
        process = subprocess.Popen(command(STOPPED), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while not all(file.exists() for file in wanted):
            time.sleep(0.002)
            assert process.poll() is None
        process.kill()
        process.wait()


def tearDownModule():
    FOLDER.cleanup()


def content(directory):
    return {entry.name: entry.read_bytes() for entry in directory.iterdir()}


def damage(file):
    """Flips a bit, or cuts the file off."""
    content = bytearray(file.read_bytes())
    at = CHANCE.randrange(len(content))
    if CHANCE.random() < 0.5:
        content[at] ^= 1 << CHANCE.randrange(8)
    else:
        del content[at:]
    file.write_bytes(bytes(content))
    return f"{file.name} damaged at {at}"


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name)

    def stopped(self):
        directory = self.path / f"run-{len(list(self.path.iterdir()))}"
        shutil.copytree(STOPPED, directory)
        return directory

    def assert_stops(self, result, code, *words):
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)

    def assert_as_if_nothing_had_happened(self, directory):
        for name in TABLES:
            self.assertEqual((directory / name).read_bytes(), (LEFT_ALONE / name).read_bytes(), name)
        self.assertEqual(summary(directory), summary(LEFT_ALONE))
        self.assertEqual((directory / "scene.json").read_bytes(), SCENE.read_bytes())
        self.assertTrue((directory / "frames.h5").exists())

    def assert_goes_on(self, directory, *options):
        result = run(directory, "--resume", *options)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assert_as_if_nothing_had_happened(directory)
        return result


class Disks(Case):
    def test_a_run_goes_on_after_a_file_size_limit_wherever_it_fell(self):
        def limit(size):
            return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

        for number, size in enumerate([0, 100, 3000, 12000, 40000, 100000, 300000, 540000]):
            directory = self.path / f"limit-{number}"
            result = run(directory, preexec_fn=limit(size))
            self.assert_stops(result, 4, str(directory), "File too large", "ulimit -f")
            if (directory / "scene.json").exists():
                first = "to go on from there" if (directory / "checkpoint.h5").exists() else "to begin again"
                self.assertIn(f"{first}: rouleau run {SCENE} --out {directory} --resume\n", result.stderr)
            self.assertEqual([], [e.name for e in directory.iterdir() if e.name.startswith(".")], "left over")
            self.assert_goes_on(directory)

    def in_namespace(self, script):
        """Runs a shell script where it may mount; skips the test where nobody may."""
        allowed = subprocess.run(["unshare", "-rm", "mount", "-t", "tmpfs", "none", self.path], capture_output=True)
        if allowed.returncode != 0:
            self.skipTest("no mount namespaces for users here")
        return subprocess.run(["unshare", "-rm", "sh", "-c", script], capture_output=True, text=True, timeout=300)

    def test_a_run_goes_on_after_a_full_disk(self):
        for kilobytes in (60, 700, 1300):
            mounted, kept = self.path / "disk", self.path / f"kept-{kilobytes}"
            mounted.mkdir(exist_ok=True)
            once = " ".join(command(mounted / "run"))
            result = self.in_namespace(
                f"mount -t tmpfs -o size={kilobytes}k none {mounted}; {once}; echo code $?;"
                f"mount -o remount,size=100m {mounted}; {once} --resume; echo code $?; cp -r {mounted}/run {kept}")
            self.assertIn("code 4", result.stdout, result.stderr)
            self.assertIn("No space left on device", result.stderr)
            self.assertIn("free some space", result.stderr)
            self.assertTrue(result.stdout.rstrip().endswith("code 0"), result.stdout + result.stderr)
            self.assert_as_if_nothing_had_happened(kept)

    def test_a_directory_that_cannot_be_written_stops_before_the_first_step(self):
        mounted = self.path / "disk"
        mounted.mkdir()
        result = self.in_namespace(f"mount -t tmpfs none {mounted}; mkdir {mounted}/run; mount -o remount,ro {mounted};"
                                   f"{' '.join(command(mounted / 'run'))}; echo code $?")
        self.assertIn("code 4", result.stdout)
        self.assertIn("Read-only file system", result.stderr)
        self.assertIn("choose a directory you may write to", result.stderr)


class Damaged_files(Case):
    def test_a_damaged_checkpoint_gives_way_to_the_one_before(self):
        for _ in range(6):
            directory = self.stopped()
            what = damage(directory / "checkpoint.h5")
            words = self.assert_goes_on(directory).stderr
            self.assertIn(f"the checkpoint before the last, for {directory / 'checkpoint.h5'}", words, what)
            resumed = json.loads((directory / "summary.json").read_text())["resumed"]
            self.assertIn("checkpoint.h5", resumed[0]["damaged_checkpoint"], what)

    def test_a_checkpoint_that_is_not_there_gives_way_too(self):
        directory = self.stopped()
        (directory / "checkpoint.h5").unlink()  # as between the two renames that change the last for a new one
        self.assert_goes_on(directory)

    def test_two_damaged_checkpoints_stop_a_run_and_change_nothing(self):
        directory = self.stopped()
        what = damage(directory / "checkpoint.h5") + ", " + damage(directory / "checkpoint-previous.h5")
        before = content(directory)
        self.assert_stops(run(directory, "--resume"), 4, "checkpoint.h5", "checkpoint-previous.h5", "--overwrite")
        self.assertEqual(content(directory), before, what)

    def test_tables_and_frames_that_were_changed_stop_a_run_and_change_nothing(self):
        for name in [*TABLES, "frames-0001.h5"]:
            directory = self.stopped()
            file = directory / name
            held = bytearray(file.read_bytes())
            held[CHANCE.randrange(min(60, len(held)))] ^= 1  # long before the checkpoint's moment
            file.write_bytes(bytes(held))
            before = content(directory)
            result = run(directory, "--resume")
            self.assert_stops(result, 4, name)
            self.assertEqual(content(directory), before, name)
            file.unlink()
            self.assert_stops(run(directory, "--resume"), 4, name)

    def test_damaged_scenes_and_manifests_have_a_place_in_the_message_and_never_crash(self):
        program, plugins = installation(self.path)
        manifest, scene = plugins / "interaction" / "morse" / "morse.json", self.path / "scene.json"
        for file, original, command, codes in (
                (scene, SCENE.read_bytes(), ["plan", scene], (0, 2)),
                (manifest, manifest.read_bytes(), ["plan", SCENE], (0, 2, 3))):
            for _ in range(25):
                file.write_bytes(original)
                what = damage(file)
                result = subprocess.run([program, *map(str, command)], capture_output=True, timeout=60)
                message = result.stderr.decode(errors="replace")
                self.assertIn(result.returncode, codes, what + message)
                if result.returncode != 0:
                    # Where what is left is a manifest of another id, parameter or limit, the scene no longer fits it.
                    self.assertRegex(message, f"{file.name}|{SCENE.name}:[0-9]+:[0-9]+ /", what)


class Other_runs(Case):
    def test_a_second_run_in_one_directory_is_refused_and_the_first_goes_on(self):
        directory = self.path / "run"
        first = subprocess.Popen(command(directory), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while not (directory / "checkpoint.h5").exists():
            time.sleep(0.002)
        for option in ([], ["--resume"], ["--overwrite"]):
            self.assert_stops(run(directory, *option), 2, "another run is writing into this directory", "--out")
        self.assertEqual(first.wait(), 0)
        self.assert_as_if_nothing_had_happened(directory)

    def test_a_run_that_has_ended_ends_again(self):
        directory = self.path / "run"
        shutil.copytree(LEFT_ALONE, directory)
        self.assert_goes_on(directory)
        self.assert_goes_on(directory, "--threads", 2)

    def test_a_checkpoint_of_another_scene_is_refused_with_each_difference(self):
        directory = self.stopped()
        before = content(directory)
        result = run(directory, "--resume", "--set", "/fluid/viscosity=1.3 cP", "--set", "/stages/0/duration=2 s")
        self.assert_stops(result, 2, "checkpoint.h5", '/fluid/viscosity: "1.2 cP" in the checkpoint, "1.3 cP" now',
                          '/stages/0/duration: "0.8 s" in the checkpoint, "2 s" now', "scene.json")
        self.assertNotIn("(--force)", result.stderr)
        result = run(directory, "--resume", "--force", "--set", "/fluid/viscosity=1.3 cP")
        self.assert_stops(result, 2, "[changes what the state means]")
        self.assertEqual(content(directory), before)

    def test_with_force_a_run_is_made_longer_and_gives_what_a_long_run_gives(self):
        longer = ["--set", "/stages/1/strain=4", "--set", "/title=longer"]
        directory, long_run = self.path / "run", self.path / "long"
        shutil.copytree(LEFT_ALONE, directory)
        self.assert_stops(run(directory, "--resume", *longer), 2, "/stages/1/strain: 3 in the checkpoint, 4 now",
                          "the run can go on all the same (--force)")
        for result in (run(directory, "--resume", "--force", *longer), run(long_run, *longer)):
            self.assertEqual(result.returncode, 0, result.stderr)
        for name in TABLES:
            self.assertEqual((directory / name).read_bytes(), (long_run / name).read_bytes(), name)
        self.assertEqual((directory / "scene.json").read_bytes(), (long_run / "scene.json").read_bytes())
        self.assertEqual(summary(directory), summary(long_run))

    def test_another_library_is_refused_and_with_force_goes_on(self):
        directory = self.stopped()
        program, plugins = installation(self.path)
        with open(plugins / "interaction" / "morse" / "libmorse.so", "ab") as library:
            library.write(b"\0")  # the same code with another hash
        self.assert_stops(run(directory, "--resume", program=program), 2, "plugin morse: 1.", "the run can go on all the same (--force)")
        result = run(directory, "--resume", "--force", program=program)
        self.assertEqual(result.returncode, 0, result.stderr)
        for name in TABLES:
            self.assertEqual((directory / name).read_bytes(), (LEFT_ALONE / name).read_bytes(), name)
        accepted = json.loads((directory / "summary.json").read_text())["resumed"][0]["accepted"]
        self.assertEqual(len(accepted), 1)
        self.assertIn("plugin morse", accepted[0])

    def test_resume_and_overwrite_exclude_each_other_and_force_wants_resume(self):
        self.assert_stops(run(self.path / "run", "--resume", "--overwrite"), 2, "give one of them")
        self.assert_stops(run(self.path / "run", "--force"), 2, "--resume")

    def test_a_run_without_checkpoints_cannot_go_on_and_says_so(self):
        directory = self.path / "run"
        never = ["--set", '/output/checkpoint="never"']
        self.assertEqual(run(directory, *never, "--max-steps", 100).returncode, 0)
        self.assertFalse((directory / "checkpoint.h5").exists())
        self.assertIsNone(json.loads((directory / "summary.json").read_text())["checkpoint_step"])
        self.assert_stops(run(directory, *never, "--resume"), 2, "no checkpoint", "--overwrite")


class Terminals_and_clocks(Case):
    def test_a_closed_terminal_ends_a_run_after_a_checkpoint(self):
        directory = self.path / "run"
        process, terminal = pty.fork()
        if process == 0:
            os.execv(PROGRAM, command(directory))
        while not (directory / "checkpoint.h5").exists():
            time.sleep(0.002)
        os.close(terminal)
        _, status = os.waitpid(process, 0)
        self.assertEqual(os.waitstatus_to_exitcode(status), 130)
        self.assertEqual(json.loads((directory / "summary.json").read_text())["status"], "interrupted")
        self.assert_goes_on(directory)

    def test_a_closed_pipe_does_not_end_a_run(self):
        directory = self.path / "run"
        reading, writing = os.pipe()
        process = subprocess.Popen(command(directory)[:-1], stdout=writing, stderr=writing)  # not --quiet
        os.close(writing)
        os.close(reading)
        self.assertEqual(process.wait(), 4)  # the path of the report could not be told
        self.assert_as_if_nothing_had_happened(directory)

    def test_a_clock_that_jumps_changes_nothing(self):
        directory = self.path / "run"
        result = run(directory, env={**os.environ, "LD_PRELOAD": str(JUMPING_CLOCK)})
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assert_as_if_nothing_had_happened(directory)
        started = json.loads((directory / "summary.json").read_text())["started"]
        self.assertNotIn(started[:3], ("202", "203"), "the clock did not jump")
        alone = json.loads((LEFT_ALONE / "summary.json").read_text())["wall_s"]
        self.assertLess(json.loads((directory / "summary.json").read_text())["wall_s"], 100 * alone + 10)

    def test_the_command_that_a_message_ends_with_goes_on_whatever_the_first_one_set(self):
        directory = self.path / "a run with spaces"
        process = subprocess.Popen(command(directory, "--set", "/fluid/viscosity=1.3 cP", "--plugin-dir", PLUGINS / "interaction"),
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        while not (directory / "checkpoint.h5").exists():
            time.sleep(0.002)
        process.terminate()
        last = process.communicate()[1].splitlines()[-1]
        self.assertEqual(process.returncode, 130)
        self.assertTrue(last.startswith("to go on: rouleau run "), last)
        words = shlex.split(last.partition(": rouleau ")[2])
        again = subprocess.run([PROGRAM, *words, "--quiet"], capture_output=True, text=True)
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertEqual(json.loads((directory / "scene.json").read_text())["fluid"]["viscosity"], "1.3 cP")
        self.assertEqual(len(json.loads((directory / "summary.json").read_text())["resumed"]), 1)

    def test_signals_of_batch_systems_and_a_time_limit_end_a_run_in_good_order_however_often_they_come(self):
        for kind in (signal.SIGUSR1, signal.SIGXCPU):
            directory = self.path / kind.name
            process = subprocess.Popen(command(directory), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            while not (directory / "checkpoint.h5").exists():
                time.sleep(0.002)
            while process.poll() is None:
                process.send_signal(kind)
                time.sleep(0.002)
            said = process.communicate()[1]
            self.assertEqual(process.returncode, 130, said)
            self.assertIn(f"ended by {kind.name}\n", said)
            self.assert_goes_on(directory)
        directory = self.path / "limited"
        result = run(directory, "--max-time", "0.2 s")
        self.assert_stops(result, 130, "ended by --max-time\n", "to go on: rouleau run")
        self.assert_goes_on(directory, "--max-time", "1h")
        for wrong, words in (("5parsecs", "is a length"), ("0", "a time above zero"), ("-1h", "a time above zero"), ("", "empty")):
            self.assert_stops(run(self.path / "none", "--max-time", wrong), 2, "--max-time", words)

    def test_threads_that_the_system_refuses_are_no_secret_of_a_library(self):
        def no_room_for_stacks():
            resource.setrlimit(resource.RLIMIT_STACK, (1 << 28, 1 << 28))  # of each thread
            resource.setrlimit(resource.RLIMIT_AS, (1 << 30, 1 << 30))
        result = run(self.path / "run", "--threads", "16", preexec_fn=no_room_for_stacks)
        self.assert_stops(result, 4, "--threads 16", "grants no more than", "take fewer")
        self.assertFalse((self.path / "run").exists())

    def test_a_second_signal_does_not_wait(self):
        directory = self.path / "run"
        process = subprocess.Popen(command(directory), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while not (directory / "checkpoint.h5").exists():
            time.sleep(0.002)
        process.send_signal(signal.SIGINT)
        process.send_signal(signal.SIGINT)
        self.assertIn(process.wait(), (-signal.SIGINT, 130))
        self.assert_goes_on(directory)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
