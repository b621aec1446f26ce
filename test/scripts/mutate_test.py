"""What scripts/mutate.sh does with a mistake: made in the copy, tested, and put back whatever happens."""
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "scripts"))
import mutate  # noqa: E402
import mutation_report  # noqa: E402

TEXT = "int least(int a, int b) { return a < b ? a : b; }\n"


def mutant(name="greater", **fields):
    return mutate.Mutant("core", name, {"file": "least.cpp", "find": "a < b", "replace": "a > b", "tests": "least_test",
                                        "why": "It is the greater one.", **fields}, "least")


class MutateTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "source").mkdir()
        (self.folder / "build").mkdir()
        (self.folder / "commit").write_text("0123456789ab\n")
        self.source = self.folder / "source" / "least.cpp"
        self.source.write_text(TEXT)
        self.run = mutate.Run(self.folder)
        self.run.seconds = {"least_test": 0.0, "other_test": 0.0}
        self.seen = []

    def try_mutant(self, tried, compiles=True, passes=lambda test: True):
        def build(*_):
            self.seen.append(self.source.read_text())
            return 0 if compiles else 1

        with mock.patch.object(self.run, "build_targets", build), \
                mock.patch.object(self.run, "test", lambda step, test, limit: (passes(test), 0.0)):
            try:
                return self.run.try_mutant("[1/1]", tried)
            finally:
                self.assertEqual(self.source.read_text(), TEXT)

    def test_a_mistake_is_built_and_seen_by_one_of_its_tests(self):
        tried = mutant(tests=["other_test", "least_test"])
        self.assertEqual(self.try_mutant(tried, passes=lambda test: test != "least_test"), ("killed", "least_test"))
        self.assertEqual(self.seen, [TEXT.replace("<", ">")])

    def test_what_no_test_sees_survives(self):
        self.assertEqual(self.try_mutant(mutant()), ("survived", ""))

    def test_what_does_not_compile_tells_nothing_of_the_tests(self):
        self.assertEqual(self.try_mutant(mutant(), compiles=False, passes=lambda test: False), ("did not compile", ""))

    def test_the_piece_must_be_there_once(self):
        for find in ("a <= b", "a"):
            self.assertEqual(self.try_mutant(mutant(find=find)), ("no longer applies", ""))
        self.assertEqual(self.try_mutant(mutant(file="gone.cpp")), ("no longer applies", ""))
        self.assertEqual(self.seen, [])

    def test_the_source_is_put_back_if_the_user_stops(self):
        def stop(_):
            raise mutate.Stopped()

        with self.assertRaises(mutate.Stopped):
            self.try_mutant(mutant(), passes=stop)

    def test_a_command_that_hangs_is_ended(self):
        code, seconds = self.run.command("waiting", ["sleep", "1000"], limit=0.1)
        self.assertIsNone(code)
        self.assertLess(seconds, 900.0)

    def test_a_program_without_tests_does_not_pass(self):
        with mock.patch.object(self.run, "program", lambda name: "/bin/true"):
            self.assertFalse(self.run.test("", "least_test")[0])

    def test_the_table_counts_what_became_of_the_mistakes(self):
        report = mutation_report.Report(self.folder)
        mutants = [mutant("one"), mutant("two"), mutant("three")]
        report.add(mutants[0], "killed", "least_test", 60.0)
        report.add(mutants[1], "survived", "", 60.0)
        table = mutation_report.table(mutation_report.Report(self.folder), mutants)
        self.assertIn("| core | 3 | 2 | 1 | 1 | 0 | 0 | 0 | 2 |", table)
        self.assertIn("0123456789ab", table)

    def test_the_list_can_be_read(self):
        mutants = mutate.read_mutants()
        self.assertGreaterEqual(len(mutants), 60)
        self.assertEqual(len({one.name for one in mutants}), len(mutants))
        for one in mutants:
            self.assertNotEqual(one.find, one.replace, one.name)


if __name__ == "__main__":
    unittest.main()
