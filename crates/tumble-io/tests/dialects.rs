//! CSV as people have it, read as `[csv]` of experiment.toml says; where it does not say, the refusal names the line to
//! write there.
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.

use tumble_core::Position;
use tumble_io::{ExperimentFolder, ReadError, read_experiment};

/// experiment.toml with further lines in `[output]`, `[bench]`, `[csv]` and `[[run]]`.
#[derive(Default, Clone, Copy)]
struct Toml {
    output: &'static str,
    bench: &'static str,
    csv: &'static str,
    run: &'static str,
}

const PLAIN: Toml = Toml { output: "", bench: "", csv: "", run: "" };

impl Toml {
    fn text(self) -> String {
        let output = if self.output.is_empty() { "quantizer = \"round\"" } else { self.output };
        format!(
            "[output]\n{output}\nnominal_scale = 0.0077\n[sensor]\n[bench]\ngravity = 9.81\n{}\n[csv]\n{}\n[[run]]\nfile = \"run.csv\"\n{}\n",
            self.bench, self.csv, self.run
        )
    }

    fn read(self, csv: impl AsRef<[u8]>) -> Result<ExperimentFolder, ReadError> {
        let dir = tempfile::tempdir().unwrap();
        std::fs::write(dir.path().join("experiment.toml"), self.text()).unwrap();
        std::fs::write(dir.path().join("run.csv"), csv).unwrap();
        read_experiment(dir.path(), &())
    }

    fn dwells(self, csv: impl AsRef<[u8]>) -> Vec<(f64, f64, u64)> {
        let folder = self.read(csv).unwrap_or_else(|e| panic!("{e}"));
        folder.experiment.runs[0].positions.iter().map(dwell).collect()
    }

    fn positions(self, csv: impl AsRef<[u8]>) -> Vec<Position> {
        self.read(csv).unwrap_or_else(|e| panic!("{e}")).experiment.runs[0].positions.clone()
    }
}

/// Angle, mean and samples.
fn dwell(p: &Position) -> (f64, f64, u64) {
    let rounded = |v: f64| (v * 1e9).round() / 1e9;
    (rounded(p.angle.deg()), rounded(p.readings.mean().unwrap()), p.readings.samples())
}

#[test]
fn one_record_in_more_dresses() {
    let expected = [(-30.5, 11.0, 2), (30.0, -7.0, 1)];
    let by_number = "columns = {angle_deg = 1, code = 2}\nheader_line = 0";
    let cases: Vec<(Toml, Vec<u8>)> = vec![
        (PLAIN, b"Angle_Deg,CODE\n-30.5,10\n-30.5,12\n30,-7\n".to_vec()),
        (PLAIN, b"sep=;\nangle_deg;code\n-30,5;10\n-30,5;12\n30;-7\n".to_vec()),
        (
            PLAIN,
            b"angle_deg,code\n  # by hand\n-30.5,1.000e+01\n-30.5,1.2000e+01\n30,-7\n".to_vec(),
        ),
        (
            Toml { bench: "angle_unit = \"dms\"", ..PLAIN },
            b"angle_deg,code\n-30 30'00\",10\n\"-30 30'00\"\"\",12\n30 0'0\",-7\n".to_vec(),
        ),
        (PLAIN, b"angle_deg|code\n-30.5|10\n-30.5|12\n30|-7\n".to_vec()),
        (PLAIN, b"angle_deg,code,\n-30.5,10,\n-30.5,12,,\n30,-7,\n".to_vec()),
        (PLAIN, "angle_deg,code\n−30.5,10\n−30.5,12\n30,−7\n".as_bytes().to_vec()),
        (PLAIN, "angle_deg,code\n-30°30',10\n-30°30′,12\n30°,-7\n".as_bytes().to_vec()),
        (PLAIN, b"angle_deg,code\n-30\xb030',10\n-30\xb030',12\n30\xb0,-7\n".to_vec()),
        (
            Toml { csv: "header_line = 4", ..PLAIN },
            b"Logger, 3\nby, me\n1,2\nangle_deg,code\n-30.5,10\n-30.5,12\n30,-7\n".to_vec(),
        ),
        (
            Toml { csv: "header_line = 1\ndata_line = 3", ..PLAIN },
            b"angle_deg,code\n[deg],[LSB]\n-30.5,10\n-30.5,12\n30,-7\n".to_vec(),
        ),
        (
            Toml { csv: "header_line = 2", ..PLAIN },
            b"# saved by a script\n# angle_deg,code\n-30.5,10\n-30.5,12\n30,-7\n".to_vec(),
        ),
        (Toml { csv: by_number, ..PLAIN }, b"-30.5,10\n-30.5,12\n30,-7\n".to_vec()),
        (Toml { csv: by_number, ..PLAIN }, b"# no header\n-30.5,10\r\n-30.5,12\r\n30,-7".to_vec()),
        (
            Toml { csv: "delimiter = \"blanks\"", ..PLAIN },
            b"  angle_deg   code\n -30.5   10\n -30.5\t12\n    30   -7  \n".to_vec(),
        ),
        (
            Toml { csv: "comment = \"%\"", ..PLAIN },
            b"% by me\nangle_deg,code\n-30.5,10\n% moved\n-30.5,12\n30,-7\n".to_vec(),
        ),
        (
            Toml { csv: "decimal = \",\"", ..PLAIN },
            b"angle_deg,code\n\"-30,5\",10\n\"-30,5\",12\n30,-7\n".to_vec(),
        ),
        (
            Toml { csv: "code_format = \"hex\"\ncode_bits = 16", ..PLAIN },
            b"angle_deg,code\n-30.5,0x000A\n-30.5,000c\n30,FFF9\n".to_vec(),
        ),
        (
            Toml { csv: "code_offset = 2048", ..PLAIN },
            b"angle_deg,code\n-30.5,2058\n-30.5,2060\n30,2041\n".to_vec(),
        ),
        (
            Toml { csv: "code_bits = 12", ..PLAIN },
            b"angle_deg,code\n-30.5,10\n-30.5,12\n30,4089\n".to_vec(),
        ),
        (
            Toml { csv: "missing = \"skip\"", ..PLAIN },
            b"angle_deg,code\n-30.5,10\n-30.5,\n-30.5,NaN\n-30.5,12\n30,-7\n".to_vec(),
        ),
        (
            Toml { csv: "rows = {sensor = \"B\"}", ..PLAIN },
            b"sensor,angle_deg,code\nA,-30.5,99\nB,-30.5,10\n\"B\",-30.5,12\nA,30,98\nB,30,-7\n"
                .to_vec(),
        ),
        (
            Toml { csv: "columns = {code = \"ay\"}", ..PLAIN },
            b"angle_deg,ax,ay,az\n-30.5,1,10,2\n-30.5,1,12,2\n30,1,-7,2\n".to_vec(),
        ),
        (
            Toml { csv: "columns = {code = \"a\"}", run: "columns = {code = \"b\"}", ..PLAIN },
            b"angle_deg,a,b\n-30.5,0,10\n-30.5,0,12\n30,0,-7\n".to_vec(),
        ),
        (
            Toml { csv: "columns = {angle_deg = \"Winkel [\u{b0}]\"}", ..PLAIN },
            b"Winkel [\xb0];code\n-30,5;10\n-30,5;12\n30;-7\n".to_vec(),
        ),
    ];
    for (toml, csv) in cases {
        assert_eq!(
            toml.dwells(&csv),
            expected,
            "{}\n{}",
            toml.text(),
            String::from_utf8_lossy(&csv)
        );
    }
}

#[test]
fn dials_count_in_many_ways() {
    let deg = |bench: &'static str, angle: &str| {
        Toml { bench, ..PLAIN }.dwells(format!("angle_deg,code\n{angle},1\n"))[0].0
    };
    assert_eq!(deg("angle_unit = \"gon\"", "-100"), -90.0);
    assert_eq!(deg("angle_unit = \"dms\"", "-12 30 36"), -12.51);
    assert_eq!(deg("angle_unit = \"dms\"", "-0:30"), -0.5);
    assert!((deg("angle_unit = \"rad\"", "0.5235987755982988") - 30.0).abs() < 1e-9);
    assert_eq!(deg("", "330"), -30.0);
    assert_eq!(deg("", "270"), -90.0);
    assert_eq!(deg("angle_sign = -1\nangle_zero_deg = 90.0", "120"), -30.0);
    assert_eq!(deg("angle_zero_deg = 180.0", "150"), -30.0);
    // ±90° from a full circle stands upright like any other.
    let p = Toml { bench: "angle_range_deg = [-65.0, 65.0]", ..PLAIN }
        .positions("angle_deg,code\n270,1\n");
    assert_eq!(p[0].seat, tumble_core::Seat::Down);
}

#[test]
fn times_give_rates_gaps_and_steps_back() {
    let of = |csv: &'static str, rows: &str| {
        let text = format!("time,angle_deg,code\n{rows}");
        let toml = Toml { csv, ..PLAIN };
        toml.positions(text)[0].record.timing.clone().unwrap()
    };
    let map = "columns = {t_s = \"time\"}\ntime_unit = \"ms\"";
    let t = of(map, "1795169730000,0,1\n1795169730020,0,1\n1795169730040,0,1\n1795169730100,0,1\n");
    assert_eq!((t.samples, t.missing(), t.longest_step_line), (4, 2, Some(5)));
    let dates = "columns = {t_s = \"time\"}\ntime_unit = \"date\"";
    let t = of(
        dates,
        "2026-11-20T10:15:30.00,0,1\n2026-11-20T10:15:30.02,0,1\n2026-11-20T10:15:29.98,0,1\n",
    );
    assert_eq!((t.backwards, t.backwards_line), (1, Some(4)));
    assert!((t.typical_step_s().unwrap() - 0.02).abs() < 1e-6);
    let t = of("columns = {t_s = \"time\"}", "0.0,0,1\n0.1,0,1\n0.1,0,1\n");
    assert_eq!((t.repeated, t.repeated_line), (1, Some(4)));
}

#[test]
fn a_clock_that_is_set_back_throws_nothing_away() {
    let mut csv = String::from("t_s,angle_deg,code\n");
    for i in 0..40 {
        let t = f64::from(i) * 0.02 + if i < 20 { 3600.0 } else { 0.0 };
        csv.push_str(&format!("{t:.2},0,{}\n", i % 3));
    }
    let p = Toml { run: "discard_s = 0.09", ..PLAIN }.positions(&csv);
    assert_eq!((p[0].readings.samples(), p[0].record.left_out), (35, [5, 0]));
}

#[test]
fn settling_is_found_and_left_out() {
    let mut csv = String::from("angle_deg,code\n");
    for angle in [0, 10] {
        for i in 0..200 {
            let code = if i < 20 { 500 - 20 * i } else { 100 + i % 3 };
            csv.push_str(&format!("{angle},{code}\n"));
        }
    }
    let p = Toml { run: "discard_s = \"detect\"", ..PLAIN }.positions(&csv);
    for dwell in &p {
        let [start, end] = dwell.record.left_out;
        assert!((20..40).contains(&start) && end == 0, "{:?}", dwell.record.left_out);
        assert!((dwell.readings.mean().unwrap() - 101.0).abs() < 0.05);
    }
}

#[test]
fn a_continuous_record_is_cut_into_dwells() {
    let mut csv = String::from("t_s,code\n");
    let mut t = 0.0;
    let mut row = |code: i32| {
        csv.push_str(&format!("{t:.2},{code}\n"));
        t += 0.02;
    };
    for (i, level) in [0, -640, -10, 600].into_iter().enumerate() {
        if i > 0 {
            (0..40).for_each(|k| row(level + 15 * (40 - k) + (k % 2) * 90));
        }
        (0..300).for_each(|k| row(level + [0, 1, 1, 0, 2][k % 5]));
    }
    let toml = Toml { run: "angles_deg = [nan, -30.0, 0.0, 28.0]", ..PLAIN };
    let p = toml.positions(&csv);
    let seen: Vec<(f64, f64)> =
        p.iter().map(|d| (dwell(d).0, d.readings.mean().unwrap().round())).collect();
    assert_eq!(seen, [(-30.0, -639.0), (0.0, -9.0), (28.0, 601.0)]);
    assert!(p.iter().all(|d| d.readings.samples() > 200 && d.record.left_out[0] >= 40));
    assert!((p[0].record.timing.as_ref().unwrap().rate_hz().unwrap() - 50.0).abs() < 0.1);
    let toml = Toml { run: "angles_deg = [-30.0, 0.0]", ..PLAIN };
    let turning: String = (0..400).map(|i| format!("{i},{}\n", i * 50)).collect();
    let refused = toml.read(format!("t_s,code\n{turning}")).unwrap_err().to_string();
    assert!(refused.contains("stand still nowhere"), "{refused}");
    let refused = toml.read(&csv).unwrap_err().to_string();
    for word in ["lists 2 angles", "stood still 4 times", "lines 2–", "nan"] {
        assert!(refused.contains(word), "{refused}");
    }
}

#[test]
fn zeros_at_the_end_and_repeats_are_told() {
    let p = PLAIN.positions("angle_deg,code\n30,5\n30,5\n0,0\n0,0\n0,0\n");
    assert_eq!(p[1].record.zero_rows, Some((4, 3)));
    assert_eq!((p[0].record.closing_repeats, p[1].record.closing_repeats), (2, 3));
    assert_eq!(p[0].record.zero_rows, None);
    assert_eq!(p[0].record.dial.as_ref().unwrap().typed, "30");
}

#[test]
fn misunderstandings_name_the_line_to_write() {
    let text = |toml: Toml, csv: &[u8]| match toml.read(csv) {
        Err(e) => e.to_string(),
        Ok(_) => panic!("read: {}", String::from_utf8_lossy(csv)),
    };
    let map = Toml { csv: "columns = {angle_deg = \"Angle [gon]\"}", ..PLAIN };
    let ms = Toml { csv: "columns = {t_s = \"t_ms\"}", ..PLAIN };
    let real = Toml {
        output: "quantizer = \"none\"\nunit = \"m/s2\"",
        csv: "columns = {output = \"ax [g]\"}",
        ..PLAIN
    };
    let volts = Toml { csv: "columns = {code = \"U [mV]\"}", ..PLAIN };
    let cases: Vec<(Toml, &[u8], &[&str])> = vec![
        (
            PLAIN,
            b"Logger 3000\nby me\n\nangle_deg,code\n0,1\n0,2\n5,3\n",
            &["line 1", "header_line = 4"],
        ),
        (PLAIN, b"angle_deg,code\n[deg],[LSB]\n0,1\n0,2\n5,3\n", &["line 2", "data_line = 3"]),
        (PLAIN, b"-30,10\n-30,12\n", &["header_line = 0", "columns = {angle_deg = 1, code = 2}"]),
        (PLAIN, b"angle_deg code\n0 1\n0 2\n5 3\n", &["delimiter = \"blanks\""]),
        (PLAIN, b"angle_deg,code\n0,0xFF\n", &["line 2", "code_format = \"hex\""]),
        (PLAIN, b"angle_deg,code\n0,FFF1\n", &["code_format = \"hex\""]),
        (PLAIN, b"angle_deg,code\n0,NaN\n", &["line 2, column code", "missing = \"skip\""]),
        (PLAIN, b"angle_deg,code\n0,\n", &["missing = \"skip\""]),
        (PLAIN, b"angle_deg,code\n,1\n", &["line 2, column angle_deg", "every row"]),
        (PLAIN, b"t_s,angle_deg,code\n10:15:30,0,1\n", &["time_unit = \"date\""]),
        (PLAIN, b"t_s,angle_deg,code\n11/20/2026 10:15,0,1\n", &["cannot be told apart"]),
        (PLAIN, b"angle_deg,code\n1,5,200\n", &["3 fields", "decimal commas between commas"]),
        (
            map,
            b"Angle [gon],code\n0,1\n",
            &["the header says gon", "angle_unit = \"gon\" in [bench]"],
        ),
        (ms, b"t_ms,angle_deg,code\n0,0,1\n", &["time_unit = \"ms\" in [csv]"]),
        (real, b"angle_deg,ax [g]\n0,0.1\n", &["the header says g", "unit = \"g\"", "m/s² per g"]),
        (volts, b"angle_deg,U [mV]\n0,1\n", &["quantizer = \"none\"", "unit = \"mV\""]),
        (
            Toml { csv: "columns = {angle = \"x\"}", ..PLAIN },
            b"x,code\n0,1\n",
            &["did you mean `angle_deg`"],
        ),
        (
            Toml { csv: "columns = {angle_deg = \"Winkel [Grad]\"}", ..PLAIN },
            b"Winkel [Grad],code\n0,1\n",
            &["the header says Grad", "angle_unit = \"deg\" or \"gon\" in [bench]"],
        ),
        (
            Toml { csv: "columns = {t_s = \"t [min]\"}", ..PLAIN },
            b"t [min],angle_deg,code\n0,0,1\n",
            &["minutes", "convert the column"],
        ),
        (
            Toml { csv: "columns = {mean_code = \"mean [V]\"}", ..PLAIN },
            b"angle_deg,mean [V],samples\n0,1.5,10\n",
            &["the header says V", "quantizer = \"none\""],
        ),
        (
            PLAIN,
            b"t_s;angle_deg;code\n0,5;0;1\n1.000;0;1\n",
            &["line 3, column t_s", "`1.000`", "thousand"],
        ),
        (PLAIN, b"angle_deg,code\n0,\"1,108\"\n", &["`1,108`", "without thousands marks"]),
        (PLAIN, b"angle_deg,code\n0,1\nend of log\n", &["line 3", "`end of log` has 1 field"]),
        (PLAIN, b"angle_deg,code\n0,1\nangle_deg,code\n", &["line 3", "header once more"]),
        (
            Toml { bench: "angle_sign = 2", ..PLAIN },
            b"angle_deg,code\n0,1\n",
            &["experiment.toml, line 7", "[bench] angle_sign = 2"],
        ),
        (
            Toml { csv: "columns = {code = 7}", ..PLAIN },
            b"angle_deg,code\n0,1\n",
            &["no column number 7"],
        ),
        (
            Toml { csv: "code_bits = 12", ..PLAIN },
            b"angle_deg,code\n0,-5\n",
            &["correct code_bits"],
        ),
        (
            Toml { csv: "rows = {sensor = \"C\"}", ..PLAIN },
            b"sensor,angle_deg,code\nA,0,1\n",
            &["`rows`"],
        ),
        (
            Toml { csv: "rows = {node = \"C\"}", ..PLAIN },
            b"sensor,angle_deg,code\nA,0,1\n",
            &["`node`"],
        ),
        (
            Toml { csv: "delimiter = \"colon\"", ..PLAIN },
            b"angle_deg,code\n0,1\n",
            &["[csv] delimiter", "\"tab\""],
        ),
        (
            Toml { csv: "header_line = 40", ..PLAIN },
            b"angle_deg,code\n0,1\n",
            &["line 40", "header_line"],
        ),
        (
            Toml { bench: "angle_unit = \"turns\"", ..PLAIN },
            b"angle_deg,code\n0,1\n",
            &["angle_unit", "\"gon\""],
        ),
        (
            Toml { run: "discard_s = \"auto\"", ..PLAIN },
            b"angle_deg,code\n0,1\n",
            &["discard_s", "\"detect\""],
        ),
        (Toml { run: "angles_deg = [0.0]", ..PLAIN }, b"angle_deg,code\n0,1\n", &["angles_deg"]),
        (
            Toml { csv: "missing = \"skip\"", ..PLAIN },
            b"angle_deg,code\n0,NaN\n0,\n5,1\n",
            &["line 2", "without a single reading"],
        ),
        (PLAIN, b"\xd0\xcf\x11\xe0....", &["old Excel file", "CSV"]),
    ];
    for (toml, csv, words) in cases {
        let seen = text(toml, csv);
        for word in words {
            assert!(
                seen.contains(word),
                "{:?}: `{seen}` does not name `{word}`",
                String::from_utf8_lossy(csv)
            );
        }
    }
}
