"""What the parts of a campaign do by themselves: python -m unittest discover campaign/tests"""

import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

CAMPAIGN = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(CAMPAIGN))
import compare  # noqa: E402
import page  # noqa: E402
import results  # noqa: E402
import season  # noqa: E402
import summary  # noqa: E402


def tow(body, day, coefficients, number=0):
    recording = season.Recording(f"{body}-{day}-{number}", body, day, "tow", ("a.csv",))
    row = {"name": recording.name, "body": body, "day": day, "kind": "tow", "import": "done", "survey": "missing", "diagnose": "missing"}
    return results.Results(recording, row, coefficients)


class Comparison(unittest.TestCase):
    def test_the_mean_of_two_that_scatter_is_as_uncertain_as_their_scatter(self):
        alike, apart = compare.mean([(1.0, 0.1), (1.1, 0.1)]), compare.mean([(1.0, 0.1), (2.0, 0.1)])
        self.assertAlmostEqual(alike.value, 1.05)
        self.assertAlmostEqual(alike.std, 0.1 / 2**0.5)
        # Two values: their standard deviation over the root of two is half their distance.
        self.assertAlmostEqual(apart.std, 0.5)
        self.assertIsNone(compare.mean([(0.0, 0.0)]))

    def test_a_change_is_told_on_its_day_and_no_other(self):
        still = [(float(term), 1.0) for term in range(18)]
        moved = [(value + (12.0 if term == 3 else 1.0), std) for term, (value, std) in enumerate(still)]
        days = ("2026-06-01", "2026-06-02", "2026-06-05")
        tows = [tow("a", day, moved if day == days[2] else still) for day in days] + [tow("b", day, still) for day in days]
        found = {(row["body"], row["day"]): row["changed"] for row in compare.days_of(tows) if row["changed"]}
        self.assertEqual(list(found), [("a", days[2])])
        (term, change), = found["a", days[2]]
        self.assertEqual(term, "induced xx")
        self.assertAlmostEqual(change, 12 / 2**0.5)

    def test_a_day_without_a_survey_does_not_hide_the_change_over_it(self):
        one, other = [(0.0, 1.0)] * 18, [(30.0, 1.0)] * 18
        rows = compare.days_of([tow("a", "2026-06-01", one), tow("a", "2026-06-02", []), tow("a", "2026-06-03", other)])
        self.assertEqual([len(row["changed"]) for row in rows], [0, 0, 18])

    def test_the_page_holds_no_markup_of_others(self):
        one = tow("<b>", "2026-06-01", [(1.0, 1.0)] * 18)
        one.problems = ["import: <script>alert(1)</script>"]
        text = page.page(summary.summed([one], []), [one])
        self.assertIn("&lt;script&gt;alert", text)
        self.assertNotIn("<script", text)
        self.assertNotIn("<b>", text)


class Unknowns(unittest.TestCase):
    """With a program in place of host-sim that names the effect of "b" on all but "c", and cannot read that of "a"."""

    PROGRAM = """import json, pathlib, sys
out, file = (pathlib.Path(sys.argv[sys.argv.index(option) + 1]) for option in ("--out", "--effect-file"))
if "a" in file.parts:
    sys.exit(2)
named = "b" in file.parts and out.name != "c"
out.mkdir(parents=True)
(out / "diagnosis.json").write_text(json.dumps({"effects": [{"name": "proposed_pump"}] if named else []}))
"""

    def season(self, folder, drivers):
        lines = ["name,body,day,kind,file"]
        for name, (driver, low) in drivers.items():
            lines.append(f"{name},x,2026-06-01,tow,{name}.csv")
            own = folder / "results" / name / "diagnosis"
            own.mkdir(parents=True)
            rest = {"drivers": [{"input": driver, "probability": 0.9}], "effect_file": None, "gap_closed": None}
            if low is not None:
                rest |= {"effect_file": "proposed_effect.toml", "gap_closed": {"fraction": 0.8, "ci95": [low, 0.9]}}
                (own / "proposed_effect.toml").write_text(f'name = "proposed_pump"\n# of {name}\n')
            (own / "diagnosis.json").write_text(json.dumps({"unexplained": rest}))
        (folder / "season.csv").write_text("\n".join(lines) + "\n")
        (folder / "program.py").write_text(f"#!{sys.executable}\n{self.PROGRAM}")
        (folder / "program.py").chmod(0o755)

    def clusters(self, folder):
        command = [sys.executable, CAMPAIGN / "unknowns.py", "--host-sim", "./program.py", "--out", "unknowns", "--options", "[]", "--threads", "2"]
        subprocess.run(command, cwd=folder, check=True, stderr=subprocess.DEVNULL)
        return (folder / "unknowns" / "unknowns.json").read_bytes()

    def test_what_nobody_else_has_seen_stands_for_no_cluster(self):
        with tempfile.TemporaryDirectory() as temporary:
            folder = Path(temporary)
            self.season(folder, {"a": ("depth", 0.7), "c": ("depth", None), "d": ("depth", None)})
            (cluster,) = json.loads(self.clusters(folder))["clusters"]
            self.assertEqual((cluster["proposed_on"], cluster["seen_on"], cluster["effect_file"]), (None, [], None))
            self.assertTrue(cluster["text"].startswith("on 3 of 3 recordings, with depth; no effect that was proposed"))
            self.assertEqual([path.name for path in (folder / "unknowns").iterdir()], ["unknowns.json"])

    def test_the_proposal_that_most_recordings_bear_out_stands_for_its_cluster(self):
        with tempfile.TemporaryDirectory() as temporary:
            folder = Path(temporary)
            pump = "current_pump_A"
            drivers = {"a": (pump, 0.7), "b": (pump, 0.6), "c": (pump, None), "d": (pump, None), "e": ("depth", 0.5), "f": ("none", None)}
            self.season(folder, drivers)
            texts = [self.clusters(folder) for _ in range(2)]
            self.assertEqual(*texts)
            (cluster,) = json.loads(texts[0])["clusters"]
            self.assertEqual((cluster["proposed_on"], cluster["seen_on"]), ("b", ["a", "b", "d"]))
            self.assertEqual(cluster["text"], "seen on 3 of 6 recordings, with current_pump_A")
            file = (folder / "unknowns" / cluster["effect_file"]).read_text()
            self.assertEqual(file.splitlines()[0], f"# {cluster['text']}")
            self.assertIn("# of b", file)
            self.assertFalse((folder / "unknowns" / "tried").exists())
            self.assertIn("seen on 3 of 6", page.page(summary.summed([], [], [cluster]), []))


class Table(unittest.TestCase):
    def test_a_tow_has_the_latest_calibration_of_its_body_unless_it_asks_for_another(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "season.csv"
            rows = ["name,body,day,kind,file,calibration,survey", "c1,a,2026-06-01,calibration,x,,", "c2,a,2026-06-03,calibration,x,,"]
            rows += ["t0,a,2026-05-31,tow,x,,", "t1,a,2026-06-02,tow,x,,", "t2,a,2026-06-03,tow,x;y,,--layback-m 30", "t3,a,2026-06-09,tow,x,c1,", "t4,b,2026-06-09,tow,x,,"]
            path.write_text("\n".join(rows) + "\n")
            found = {row.name: row for row in season.read(path)}
        self.assertEqual([found[f"t{number}"].calibration for number in range(5)], [None, "c1", "c2", "c1", None])
        self.assertEqual((found["t2"].files, found["t2"].options["survey"]), (("x", "y"), ("--layback-m", "30")))

    def test_what_no_effect_explains_is_read_of_old_programs_and_new(self):
        test = {"channel": "scalar", "what": "lines", "p_value": 1e-9}
        driver = {"input": "depth", "probability": 0.8}
        self.assertEqual(results._unexplained([test]), "lines")
        self.assertEqual(results._unexplained({"drivers": [driver], "tests": [test]}), "depth (0.80) lines")
        self.assertEqual(results._unexplained({"drivers": [{"input": "none", "probability": 1.0}]}), "")
        self.assertEqual(results._unexplained(None), "")


class Step(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = Path(self.folder.name)
        self.addCleanup(self.folder.cleanup)

    def step(self, script, *options):
        command = [sys.executable, CAMPAIGN / "step.py", "outcomes/a/survey.json", "--log", "logs/a/survey.log", *options]
        command += ["--results", "made", "--command", "sh", "-c", script, "--"]
        return subprocess.run(command, cwd=self.path, capture_output=True, text=True, check=False)

    def outcome(self):
        return json.loads((self.path / "outcomes/a/survey.json").read_text())

    def test_bad_input_is_an_outcome_and_a_failure_is_none(self):
        self.assertEqual(self.step("echo warning >&2; echo it is bad >&2; exit 2").returncode, 0)
        self.assertEqual((self.outcome()["outcome"], self.outcome()["message"]), ("refused", "it is bad"))
        (self.path / "outcomes/a/survey.json").unlink()
        for script in ("exit 1", "kill -9 $$", "exit 101", "exit 0"):
            self.assertEqual(self.step(script).returncode, 1, script)
            self.assertFalse((self.path / "outcomes/a/survey.json").exists(), script)
        self.assertEqual(self.step("touch made").returncode, 0)
        self.assertEqual((self.outcome()["outcome"], self.outcome()["results"]), ("done", ["made"]))
        self.assertEqual((self.path / "logs/a/survey.log").read_text().count("started: "), 6)

    def test_what_follows_a_bad_recording_is_left_out_and_a_bad_calibration_is_done_without(self):
        (self.path / "outcomes/c").mkdir(parents=True)
        bad = self.path / "outcomes/c/calibrate.json"
        bad.write_text(json.dumps({"outcome": "refused"}))
        self.assertEqual(self.step("touch made", "--needs", "outcomes/c/calibrate.json").returncode, 0)
        self.assertEqual(self.outcome()["outcome"], "left_out")
        self.assertFalse((self.path / "made").exists())
        script = 'echo "$@" > made'
        self.assertEqual(self.step(script, "--coefficients", "outcomes/c/calibrate.json", "c.toml").returncode, 0)
        self.assertEqual(self.outcome()["without"], "calibrate of c was refused")
        bad.write_text(json.dumps({"outcome": "done"}))
        self.assertEqual((self.path / "made").read_text(), "\n")
        self.step(script, "--coefficients", "outcomes/c/calibrate.json", "c.toml")
        self.assertEqual((self.path / "made").read_text(), "--coefficients c.toml\n")


if __name__ == "__main__":
    unittest.main()
