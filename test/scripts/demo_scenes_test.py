"""The menu of scripts/demo.sh: every scene of config/sim is in it, and has a picture."""
import importlib.util
import pathlib
import subprocess
import unittest

ROOT = pathlib.Path(__file__).parents[2]
SCENES = sorted(path.stem for path in (ROOT / "config" / "sim").glob("*.yaml"))


def run(*arguments):
    return subprocess.run([ROOT / "scripts" / "demo.sh", *arguments], check=False, capture_output=True, text=True)


class DemoScenesTest(unittest.TestCase):
    def test_all_are_listed_with_what_they_are(self):
        listed = run("--scenes")
        self.assertEqual(listed.returncode, 0, listed.stderr)
        lines = listed.stdout.splitlines()
        self.assertEqual([line.split()[0] for line in lines], SCENES)
        for line in lines:
            self.assertGreater(len(line.split()), 4, line)

    def test_others_are_refused(self):
        for arguments in (["--scene", "no_scene"], ["--scene"], ["--scene", "plug"], ["--scene", "--headless"]):
            refused = run(*arguments)
            self.assertEqual(refused.returncode, 2)
            self.assertIn(f"--scene needs one of {' '.join(SCENES)}", refused.stderr)
        self.assertIn("--continuous is not for --scene", run("--scene", "knot", "--continuous").stderr)

    def test_all_have_a_picture(self):
        spec = importlib.util.spec_from_file_location("sim_pictures", ROOT / "scripts" / "sim_pictures.py")
        pictures = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(pictures)
        self.assertEqual(sorted(pictures.SCENES), SCENES)


if __name__ == "__main__":
    unittest.main()
