# SPDX-License-Identifier: GPL-3.0-or-later
"""Ranks runs of the suite whose tables are made up: test_ranking.py RANKING.py"""
import contextlib, csv, importlib.util, io, json, pathlib, sys, tempfile, unittest

try:
    import scipy  # noqa: F401
except ImportError:
    print("skipped: python3-scipy is not installed")
    sys.exit(77)
specification = importlib.util.spec_from_file_location("ranking", sys.argv.pop(1))
ranking = importlib.util.module_from_spec(specification)
specification.loader.exec_module(ranking)
COLUMNS = ["case", "domain", "pipeline", "status", "reason", "eta_mean", "eta_worst", "d4", "tau", "percent_quads", "seconds_total"]


def cell(case, eta=1.0, tau=100, quads=100, status="ok", **more):
    values = {"eta_mean": eta, "eta_worst": eta / 2, "d4": 90, "tau": tau, "percent_quads": quads, "seconds_total": 1}
    return {"case": case, "domain": case.rsplit("_", 1)[0], "status": status, **(values if status in ("ok", "unsound") else {}), **more}


class Ranking(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def write(self, run, experiment, program, cells, title="Suite 2"):
        folder = self.folder / run / experiment
        folder.mkdir(parents=True)
        (folder / "study.json").write_text(json.dumps({"experiment": experiment, "title": title}))
        with (folder / "runs.csv").open("w", newline="") as out:
            columns = COLUMNS + sorted({key for c in cells for key in c} - set(COLUMNS))
            table = csv.DictWriter(out, columns)
            table.writeheader()
            table.writerows({"pipeline": program, **c} for c in cells)

    def rank(self):
        with contextlib.redirect_stdout(io.StringIO()) as out:
            ranking.main(self.folder)
        self.assertEqual((self.folder / "ranking/table.md").read_text(), out.getvalue())
        with (self.folder / "ranking/table.csv").open(newline="") as table:
            self.rows = [(r["family"], r["program"]) for r in csv.DictReader(table)]
        with (self.folder / "ranking/table.csv").open(newline="") as table:
            return {(r["family"], r["program"]): r for r in csv.DictReader(table)}, out.getvalue()

    def test_failures_stand_apart_from_absent_cells(self):
        triangles_only = cell("gear_3", tau=70, quads=0, eta_mean="", eta_worst="")  # they have no eta of quads
        self.write("a", "planar", "few", [cell("gear_1"), cell("gear_2", quads=50), triangles_only])
        self.write("a", "cad", "few", [cell("bracket_1", status="failed"), cell("bracket_2", status="unsound")])
        for family, models in {"planar": 14, "cad": 14, "triangles": 12, "hard": 14, "metric": 14}.items():
            names = ["gear", "bracket", *(f"{family}{i}" for i in range(models))][:models]
            self.write("b", family, "more", [cell(f"{name}_{k}", 0.5, 80) for name in names for k in (1, 2, 3)])
        table, _ = self.rank()
        self.assertEqual(self.rows[:4], [("all", "more"), ("all", "few"), ("planar", "more"), ("planar", "few")])
        self.assertAlmostEqual(float(table["all", "more"]["score"]), 40)
        self.assertEqual(table["all", "more"]["solved"], str(120 + 42))  # without metrics
        few = table["all", "few"]
        self.assertEqual([few[c] for c in ("models", "cases", "solved", "with triangles", "failed")], ["2", "5", "1", "2", "2"])
        # The gear's three cases have 100, 50 and 0, the bracket's two 0.
        self.assertAlmostEqual(float(few["score"]), 25)
        self.assertAlmostEqual(float(few["score_half_width"]), 12.706205 * 25, 4)
        self.assertEqual([float(few[c]) for c in ("eta worst", "eta mean", "tau")], [0.5, 1, 90])
        cad = table["cad", "few"]
        self.assertEqual((cad["failed"], cad["cases"], cad["eta mean"]), ("2", "2", "nan"))
        self.assertNotIn(("triangles", "few"), self.rows)

    def test_models_are_the_sample(self):
        for program, models, eta in ("all", 14, 0.8), ("low", 14, 0.7), ("six", 6, 0.9):
            self.write(program, "planar", program, [cell(f"m{i}_{k}", eta + i / 1000) for i in range(models) for k in (1, 2, 3)])
        table, text = self.rank()
        # All models agree: p is 2^-13 over 14 models and 2^-5 over six. That is too much for a family of six tests, though it would be 18 cases.
        for family in "all", "planar":
            self.assertEqual([p for f, p in self.rows if f == family], ["all", "low", "six"])  # fewer cases stand below
            self.assertEqual([table[family, p]["better than"] for p in ("all", "low", "six")], ["low", "", ""])
        self.assertIn("2 of 6 tests count", text)

    def test_metrics_stand_apart(self):
        in_metric = {"metric_eta_mean": 0.8, "metric_eta_worst": 0.3, "metric_tau": 90}
        self.write("a", "metric", "told", [cell("metric_thin_1", 0.1, "", **in_metric)])
        self.write("b", "metric", "sizes", [cell("metric_thin_1", status="not applicable", reason="is told sizes")])
        self.write("a", "planar", "told", [cell("gear_1", 0.5, 80)])
        self.write("b", "planar", "sizes", [cell("gear_1", 0.6, 80)])
        table, text = self.rank()
        self.assertEqual(self.rows, [("all", "sizes"), ("all", "told"), ("planar", "sizes"), ("planar", "told"), ("metric", "told"), ("metric", "sizes")])
        self.assertAlmostEqual(float(table["all", "sizes"]["score"]), 48)
        self.assertAlmostEqual(float(table["metric", "told"]["score"]), 72)
        self.assertEqual(float(table["metric", "told"]["eta worst"]), 0.3)
        self.assertIn("| metric | sizes | not applicable |", text)
        self.assertIn("* sizes is not applicable to metric: is told sizes\n", text)

    def test_programs_of_one_name_have_their_folder(self):
        for run in "a", "b":
            self.write(run, "planar", "DB", [cell("gear_1")])
        self.rank()
        self.assertEqual(self.rows[:2], [("all", "DB"), ("all", "b/planar/DB")])

    def test_refuses_other_results(self):
        with self.assertRaisesRegex(SystemExit, "has no runs.csv"):
            ranking.main(self.folder)
        self.write("a", "planar", "DB", [cell("gear_1")])
        self.write("b", "planar", "DBCO", [cell("gear_1")], "Suite 3")
        with self.assertRaisesRegex(SystemExit, "b/planar: holds results of 'Suite 3', not of 'Suite 2'"):
            ranking.main(self.folder)


if __name__ == "__main__":
    unittest.main()
