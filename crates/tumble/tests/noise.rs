//! `tumble noise` as a user meets it: published figures, files as people have them, hostile ones.
//!
//! Past 500 lines: one list of what a record can be.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // A test that cannot unwrap has failed; figures are for people.

mod common;

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use common::{err, tumble};
use tumble_io::noise::{CurveEntry, NoiseDocument};

/// Writes a file, analyses it, gives the document.
fn analysed(text: &[u8], extra: &[&str]) -> NoiseDocument {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("r.csv"), text).unwrap();
    let args = [&["noise", "r.csv", "--json"], extra].concat();
    let o = tumble(dir.path(), &args);
    assert_eq!(o.status.code(), Some(0), "{}", err(&o));
    serde_json::from_slice(&o.stdout).unwrap()
}

/// What a file is refused with.
fn refused(text: &[u8], extra: &[&str]) -> String {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("r.csv"), text).unwrap();
    let o = tumble(dir.path(), &[&["noise", "r.csv"], extra].concat());
    assert_eq!(o.status.code(), Some(2), "{}", err(&o));
    assert!(o.stdout.is_empty());
    err(&o)
}

/// The thousand points of NIST SP 1065.
fn nbs14() -> Vec<f64> {
    let mut state = 1_234_567_890u64;
    (0..1000)
        .map(|_| {
            let y = state as f64 / 2_147_483_647.0;
            state = 16_807 * state % 2_147_483_647;
            y
        })
        .collect()
}

/// Noise of a converter: codes about a mean.
fn codes(count: usize) -> Vec<i64> {
    let mut state = 99u64;
    let mut uniform = move || {
        state = 16_807 * state % 2_147_483_647;
        state as f64 / 2_147_483_647.0
    };
    (0..count)
        .map(|_| (100.0 + 3.0 * ((0..6).map(|_| uniform()).sum::<f64>() - 3.0)).round() as i64)
        .collect()
}

fn lines<T: std::fmt::Display>(values: &[T]) -> String {
    values.iter().fold(String::new(), |mut text, v| {
        let _ = writeln!(text, "{v}");
        text
    })
}

fn at(curve: &CurveEntry, factor: u64) -> f64 {
    curve.points.iter().find(|p| p.factor == factor).unwrap().deviation
}

/// Half a unit of the last published digit.
const SEVEN_DIGITS: f64 = 5e-8;

/// NIST SP 1065, table 32; decade times hold the published 1, 10 and 100.
#[test]
fn thousand_points_of_sp_1065() {
    let text = lines(&nbs14());
    let d = analysed(
        text.as_bytes(),
        &["--rate", "1", "--taus", "decade", "--deviation", "allan,modified,hadamard,total"],
    );
    let published = [
        ("oadev", [0.292_231_9, 0.091_599_53, 0.032_413_43]),
        ("mdev", [0.292_231_9, 0.061_723_76, 0.021_709_21]),
        ("hdev", [0.294_388_3, 0.095_810_83, 0.032_376_38]),
        ("totdev", [0.292_231_9, 0.091_347_43, 0.034_065_30]),
    ];
    for (name, expected) in published {
        let curve = d.curves.iter().find(|c| c.deviation == name).unwrap();
        for (factor, expected) in [1, 10, 100].into_iter().zip(expected) {
            assert!((at(curve, factor) - expected).abs() < SEVEN_DIGITS, "{name} {factor}");
        }
    }
    let all = analysed(text.as_bytes(), &["--rate", "1", "--taus", "all"]);
    assert_eq!(all.curves[0].points.len(), 333);
    assert!((at(&all.curves[0], 10) - 0.091_599_53).abs() < SEVEN_DIGITS);
}

/// PHASE.DAT of Stable32 against Stable32's own table, deviations to its five digits and bands to 3 % for white noise.
#[test]
fn phase_dat_of_stable32() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/allan_reference");
    let Ok(phase) = std::fs::read_to_string(folder.join("phasedat/PHASE.DAT")) else {
        eprintln!("skipped: no {}", folder.display());
        return;
    };
    let phase: Vec<f64> = phase.lines().filter_map(|l| l.trim().parse().ok()).collect();
    let readings: Vec<f64> = phase.windows(2).map(|w| w[1] - w[0]).collect();
    let d = analysed(lines(&readings).as_bytes(), &["--rate", "1"]);
    let table = std::fs::read_to_string(folder.join("phase_dat_oadev_octave.txt")).unwrap();
    let mut seen = 0;
    for line in table.lines() {
        let numbers: Vec<f64> = line.split_whitespace().filter_map(|n| n.parse().ok()).collect();
        let [factor, _, _, alpha, low, sigma, high] = numbers[..] else { continue };
        let Some(p) = d.curves[0].points.iter().find(|p| p.factor == factor as u64) else {
            continue;
        };
        assert!((p.deviation / sigma - 1.0).abs() < 1e-4, "{line}");
        // Stable32 sums over discrete points, which at m = 1 gives up to 20 % more degrees of freedom.
        if alpha == 0.0 && p.kind.as_deref() == Some("white") {
            let [l, h] = p.band.unwrap();
            assert!((l / low - 1.0).abs() < 0.03 && (h / high - 1.0).abs() < 0.03, "{line} {p:?}");
        }
        seen += 1;
    }
    assert!(seen >= 7, "{seen}");
}

#[test]
fn files_as_people_have_them_say_the_same() {
    let codes = codes(4000);
    let plain = analysed(lines(&codes).as_bytes(), &["--rate", "50"]);
    assert_eq!(plain.unit, "LSB");
    let curve = &plain.curves[0];
    let mut semicolon = String::from("\u{feff}t_s;angle;output\r\n");
    let mut named = String::from("# a logger\nseq,acc_x,note\n");
    for (i, c) in codes.iter().enumerate() {
        let _ = write!(
            semicolon,
            "{};0;{c},0\r\n",
            format!("{:.3}", i as f64 * 0.02).replace('.', ",")
        );
        let _ = writeln!(named, "{i},{c},x");
    }
    let by_times = analysed(semicolon.as_bytes(), &[]);
    assert!((by_times.input.rate_hz - 50.0).abs() < 1e-6, "{}", by_times.input.rate_hz);
    assert_eq!(by_times.curves[0].points.len(), curve.points.len());
    for (a, b) in by_times.curves[0].points.iter().zip(&curve.points) {
        assert!((a.deviation / b.deviation - 1.0).abs() < 1e-12);
    }
    for column in ["acc_x", "2"] {
        let d = analysed(named.as_bytes(), &["--rate", "50", "--column", column]);
        assert_eq!(d.curves[0], plain.curves[0]);
    }
    let mut packed = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    packed.write_all(lines(&codes).as_bytes()).unwrap();
    assert_eq!(analysed(&packed.finish().unwrap(), &["--rate", "50"]).curves, plain.curves);
    // m/s², by number and by catalogue: everything is multiplied.
    let scaled = analysed(lines(&codes).as_bytes(), &["--rate", "50", "--scale", "0.01"]);
    assert!((at(&scaled.curves[0], 8) / at(curve, 8) / 0.01 - 1.0).abs() < 1e-12);
    let n = &scaled.fit.as_ref().unwrap().coefficients[1];
    let density = &n.sheet[0];
    assert_eq!(density.unit, "ug/rtHz");
    assert!((density.value / (n.value * 2f64.sqrt() / 9.80665e-6) - 1.0).abs() < 1e-12);
}

#[test]
fn gaps_cut_the_record_and_nothing_is_filled_in() {
    let codes = codes(3000);
    let mut text = String::from("t_s,code\n");
    for (i, c) in codes.iter().enumerate() {
        if (1000..1010).contains(&i) {
            continue;
        }
        let code = if i == 2000 { "nan".to_owned() } else { c.to_string() };
        let _ = writeln!(text, "{:.2},{code}", i as f64 * 0.01);
    }
    let d = analysed(text.as_bytes(), &[]);
    assert_eq!(d.input.pieces, [1000, 990, 999]);
    assert_eq!((d.input.missing, d.input.rows_without_reading), (11, 1));
    assert!(d.remarks.iter().any(|r| r.contains("missing")), "{:?}", d.remarks);
    // Pooled by hand: no difference reaches across.
    let pieces = [&codes[..1000], &codes[1010..2000], &codes[2001..]];
    let (mut sum, mut terms) = (0.0, 0.0);
    for piece in pieces {
        let own = analysed(lines(piece).as_bytes(), &["--rate", "100"]);
        let p = own.curves[0].points.iter().find(|p| p.factor == 16).unwrap();
        sum += p.deviation.powi(2) * p.terms as f64;
        terms += p.terms as f64;
    }
    assert!((at(&d.curves[0], 16).powi(2) / (sum / terms) - 1.0).abs() < 1e-12);
    let message = refused(text.as_bytes(), &["--deviation", "total"]);
    assert!(message.contains("leave total out"), "{message}");
}

#[test]
fn what_cannot_be_analysed_is_refused_with_a_remedy() {
    let cases: [(&[u8], &[&str], &str); 12] = [
        (b"1\n2\n3\n", &[], "--rate HZ"),
        (b"1\n2\n3\n", &["--rate", "10"], "too few"),
        (b"", &["--rate", "10"], "no readings"),
        (b"a,b\n1,2\n", &["--rate", "10"], "--column"),
        (b"code\n1\nx\n", &["--rate", "10"], "line 3, column code"),
        (b"1\n2\n\x00\xff\n", &["--rate", "10"], "line 3"),
        (b"1,2,3\n4,5,6\n", &["--rate", "10"], "--column 2"),
        (b"code,t_s\n1,0\n2,1\n1,0.5\n", &[], "line 4, column t_s"),
        (b"code,t_s\n1,0\n2,0\n1,0\n", &[], "do not grow"),
        (b"PK\x03\x04zip", &["--rate", "10"], "zip"),
        (b"1e400\n1\n", &["--rate", "10"], "line"),
        (b"1\n2\n", &["--rate", "10", "--sensor", "ADXL203"], "analogue"),
    ];
    for (text, extra, expected) in cases {
        let message = refused(text, extra);
        assert!(message.contains(expected), "{expected}: {message}");
    }
    let constant = refused(lines(&[7; 100]).as_bytes(), &["--rate", "10"]);
    assert!(constant.contains("all readings are 7"), "{constant}");
    // A logger in bursts, and a rate that is none.
    let mut uneven = String::from("t_s,code\n");
    for (i, c) in codes(2000).iter().enumerate() {
        let _ = writeln!(uneven, "{},{c}", i as f64 + if i % 2 == 0 { 0.0 } else { 0.3 });
    }
    let message = refused(uneven.as_bytes(), &[]);
    assert!(message.contains("no constant rate"), "{message}");
    let mut holes = String::from("t_s,code\n");
    for (i, c) in codes(9000).iter().enumerate().filter(|(i, _)| i % 7 != 3) {
        let _ = writeln!(holes, "{i},{c}");
    }
    let message = refused(holes.as_bytes(), &[]);
    assert!(message.contains("more than 1000 gaps"), "{message}");
}

#[test]
fn stuck_and_clipped_readings_are_named() {
    let mut stuck = codes(4000);
    stuck[1000..1200].fill(101);
    let d = analysed(lines(&stuck).as_bytes(), &["--rate", "50"]);
    assert!(d.remarks.iter().any(|r| r.contains("stuck")), "{:?}", d.remarks);
    let clipped: Vec<i64> = codes(4000).iter().map(|c| (*c).min(101)).collect();
    let wide: Vec<i64> = clipped.iter().map(|c| 4 * c).collect();
    let d = analysed(lines(&wide).as_bytes(), &["--rate", "50"]);
    assert!(d.remarks.iter().any(|r| r.contains("extreme value")), "{:?}", d.remarks);
    let quiet = analysed(lines(&codes(4000)).as_bytes(), &["--rate", "50"]);
    assert!(quiet.remarks.is_empty(), "{:?}", quiet.remarks);
}

#[test]
fn the_folder_and_the_table() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("<b>.csv"), lines(&codes(5000))).unwrap();
    let args = ["noise", "<b>.csv", "--rate", "50", "--scale", "0.01", "--out", "out"];
    let o = tumble(dir.path(), &args);
    assert_eq!(o.status.code(), Some(0), "{}", err(&o));
    let text = String::from_utf8(o.stdout).unwrap();
    assert!(text.lines().all(|l| l.chars().count() <= 80), "{text}");
    for part in ["best dwell", "ug/rtHz", "one-sided", "converter", "O best dwell"] {
        assert!(text.contains(part), "{part}\n{text}");
    }
    let page = std::fs::read_to_string(dir.path().join("out/noise.html")).unwrap();
    assert!(
        page.contains("&lt;b&gt;.csv") && !page.contains("<b>.csv") && !page.contains("<script")
    );
    let svg = std::fs::read_to_string(dir.path().join("out/noise.svg")).unwrap();
    assert!(svg.starts_with("<svg") && !svg.contains("NaN") && !svg.contains("inf"));
    let json = std::fs::read_to_string(dir.path().join("out/noise.json")).unwrap();
    serde_json::from_str::<NoiseDocument>(&json).unwrap();
    let again = tumble(dir.path(), &args);
    assert!(err(&again).contains("already"), "{}", err(&again));
}

#[test]
fn times_are_read_as_loggers_write_them() {
    let codes = codes(3000);
    let table = |header: &str, time: &dyn Fn(usize) -> String| {
        codes.iter().enumerate().fold(format!("{header}\n"), |mut text, (i, c)| {
            let _ = writeln!(text, "{},{c},x", time(i));
            text
        })
    };
    let ms = |i: usize| format!("{}", 1_700_000_000_000 + 20 * i as u64);
    let date = |i: usize| {
        let t = 0.02 * i as f64;
        format!("2026-11-20T10:{:02}:{:06.3}Z", (t / 60.0) as u64, t % 60.0)
    };
    let plain = |i: usize| format!("{}", 20 * i);
    let cases: [(String, &[&str]); 6] = [
        (table("t_ms,acc_x,note", &ms), &["--time", "t_ms", "--column", "acc_x"]),
        (table("time (ms),code,note", &ms), &["--time", "1"]),
        (table("timestamp,code,note", &date), &["--time", "timestamp"]),
        (table("t_s,code,note", &date), &[]),
        (table("t_s,code,note", &plain), &["--time-unit", "ms"]),
        (
            table("0,100,x", &plain).replacen("0,100,x\n", "", 1),
            &["--time", "1", "--time-unit", "ms", "--column", "2"],
        ),
    ];
    let expected = analysed(lines(&codes).as_bytes(), &["--rate", "50"]);
    for (text, extra) in cases {
        // Without names the third column could be no header's, either.
        let text = if extra.len() == 6 { text.replace(",x", ",0") } else { text };
        let d = analysed(text.as_bytes(), extra);
        assert!((d.input.rate_hz - 50.0).abs() < 1e-3, "{extra:?}: {}", d.input.rate_hz);
        assert_eq!((d.input.rate_from.as_str(), d.input.missing), ("times", 0), "{extra:?}");
        assert!(d.remarks.is_empty(), "{extra:?} {:?}", d.remarks);
        let points = d.curves[0].points.iter().zip(&expected.curves[0].points);
        for (a, b) in points {
            assert!((a.deviation / b.deviation - 1.0).abs() < 1e-12, "{extra:?}");
        }
    }
    // Taken as seconds, and said so: 20 s a reading is no logger's way.
    let d = analysed(table("t_s,code,note", &plain).as_bytes(), &[]);
    assert!((d.input.rate_hz - 0.05).abs() < 1e-9);
    assert!(d.remarks.iter().any(|r| r.contains("--time-unit ms")), "{:?}", d.remarks);
    let refusals: [(String, &[&str], &str); 4] = [
        (table("t_ms,code,note", &ms), &[], "--time 't_ms'"),
        (
            table("t_ms,code,note", &ms),
            &["--time", "t"],
            "say which one holds the times: --time t_ms",
        ),
        (table("t [min],code,note", &plain), &["--time", "1"], "minutes or hours"),
        (table("t_s,code,note", &date), &["--time-unit", "s"], "--time-unit date"),
    ];
    for (text, extra, says) in refusals {
        let message = refused(text.as_bytes(), extra);
        assert!(message.contains(says), "{says}: {message}");
    }
}

#[test]
fn units_are_not_guessed_but_said() {
    let text: String = codes(3000).iter().fold("acc [g]\n".into(), |mut text, c| {
        let _ = writeln!(text, "{:.3}", *c as f64 * 0.01);
        text
    });
    let d = analysed(text.as_bytes(), &["--rate", "50", "--column", "1"]);
    assert!(d.unit == "unit" && d.converter.is_none());
    assert!(d.remarks.iter().any(|r| r.contains("--scale 9.80665")), "{:?}", d.remarks);
    let codes = lines(&codes(3000));
    let sensor = |mode: &str| {
        analysed(codes.as_bytes(), &["--rate", "50", "--sensor", "adxl345", "--mode", mode])
    };
    // 256 LSB/g, however the range is written.
    for mode in ["+-2 g or full resolution", "+-2 g", "2g", "±2 g"] {
        let d = sensor(mode);
        assert!((d.scale.unwrap().m_s2_per_unit / (9.80665 / 256.0) - 1.0).abs() < 1e-12, "{mode}");
    }
    let refusals: [(&[&str], &str); 8] = [
        (&["--sensor", "ADXL345"], "--mode '+-2 g or full resolution'"),
        (&["--sensor", "ADXL345", "--mode", "+-1 g"], "no one mode `+-1 g`"),
        (&["--sensor", "ADXL34"], "is it ADXL345?"),
        (&["--scale", "-2"], "without its sign"),
        (&["--rate", "0"], "positive number"),
        (&["--rate", "-5"], "positive number"),
        (&["--rate", "1e-320"], "between 1e-6 and 1e9"),
        (&["--passport", "r.csv"], "not a passport"),
    ];
    for (extra, says) in refusals {
        let rate: &[&str] = if extra[0] == "--rate" { &[] } else { &["--rate", "50"] };
        let message = refused(codes.as_bytes(), &[rate, extra].concat());
        assert!(message.contains(says), "{says}: {message}");
    }
    for huge in ["1e300\n-1e300\n", "1e-300\n-1e-300\n"] {
        let message = refused(huge.repeat(50).as_bytes(), &["--rate", "50"]);
        assert!(message.contains("in another unit"), "{message}");
    }
}

#[test]
fn a_turned_sensor_is_no_record_of_noise() {
    let mut text = String::from("angle_deg,code\n");
    for (i, c) in codes(3000).iter().enumerate() {
        let _ = writeln!(text, "{},{c}", if i < 2000 { "-30.02" } else { "-29" });
    }
    let message = refused(text.as_bytes(), &["--rate", "50"]);
    assert!(
        message.contains("line 2002, column angle_deg") && message.contains("tumble check"),
        "{message}"
    );
    let still = text.replace("\n-29,", "\n-30,");
    assert_eq!(analysed(still.as_bytes(), &["--rate", "50"]).input.readings, 3000);
}

/// Few readings share the extreme value by chance; that is no converter's end.
#[test]
fn a_short_record_is_not_said_to_be_clipped() {
    let mut short: Vec<i64> = codes(150).iter().map(|c| c - 100).collect();
    let top = *short.iter().max().unwrap();
    (0..4).for_each(|i| short[30 * i] = top.max(5));
    let d = analysed(lines(&short).as_bytes(), &["--rate", "50"]);
    assert!(!d.remarks.iter().any(|r| r.contains("extreme")), "{:?}", d.remarks);
}

#[test]
fn another_result_is_not_overwritten() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("r.csv"), lines(&codes(3000))).unwrap();
    let run = |rate: &str, extra: &[&str]| {
        let args = ["noise", "r.csv", "--rate", rate, "--out", "out", "--quiet"];
        tumble(dir.path(), &[&args, extra].concat())
    };
    let json = || std::fs::read(dir.path().join("out/noise.json")).unwrap();
    assert_eq!(run("50", &[]).status.code(), Some(0));
    let first = json();
    let o = run("60", &[]);
    assert_eq!(o.status.code(), Some(2));
    assert!(err(&o).contains("--replace"), "{}", err(&o));
    assert_eq!(json(), first);
    assert_eq!(run("60", &["--replace"]).status.code(), Some(0));
    assert_ne!(json(), first);
    assert_eq!(std::fs::read(dir.path().join("out.old-1/noise.json")).unwrap(), first);
}

#[cfg(unix)]
#[test]
fn a_pipe_is_read_as_it_comes() {
    use std::process::Stdio;
    let text = lines(&codes(4000));
    let dir = tempfile::tempdir().unwrap();
    let start = |args: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_tumble"));
        command.args(["noise", "-", "--rate", "50"]).args(args).current_dir(dir.path());
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
    };
    let mut child = start(&["--json"]);
    child.stdin.take().unwrap().write_all(text.as_bytes()).unwrap();
    let o = child.wait_with_output().unwrap();
    let d: NoiseDocument = serde_json::from_slice(&o.stdout).unwrap();
    let file = analysed(text.as_bytes(), &["--rate", "50"]);
    assert_eq!((&d.curves, &d.input.sha256), (&file.curves, &file.input.sha256));
    // Ctrl-C while it waits: at once, with 130, and nothing is left behind.
    let mut child = start(&["--out", "out"]);
    let mut pipe = child.stdin.take().unwrap();
    // More than a pipe holds: when it is written, the program reads, and listens to Ctrl-C.
    pipe.write_all(text.repeat(40).as_bytes()).unwrap();
    let pid = child.id().to_string();
    assert!(Command::new("kill").args(["-INT", &pid]).status().unwrap().success());
    let o = child.wait_with_output().unwrap();
    drop(pipe);
    assert_eq!(o.status.code(), Some(130), "{}", err(&o));
    assert!(o.stdout.is_empty());
    assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 0);
}

/// Rounding is drawn where noise spreads the readings, and nothing is promised where it does not.
#[test]
fn the_converter_stands_in_the_figure() {
    let page = |codes: &[i64]| {
        let dir = tempfile::tempdir().unwrap();
        std::fs::write(dir.path().join("r.csv"), lines(codes)).unwrap();
        let args = ["noise", "r.csv", "--rate", "50", "--scale", "0.01", "--out", "out", "--quiet"];
        assert_eq!(tumble(dir.path(), &args).status.code(), Some(0));
        let read = |name: &str| std::fs::read_to_string(dir.path().join("out").join(name)).unwrap();
        let d: NoiseDocument = serde_json::from_str(&read("noise.json")).unwrap();
        (read("noise.html"), read("noise.svg"), d)
    };
    let (html, svg, d) = page(&codes(5000));
    assert!(svg.contains("rounding of the converter") && svg.contains("best dwell"));
    assert!(html.contains("n = √2·N") && html.contains("µg/√Hz") && html.contains("√s"), "{html}");
    assert!(!html.contains("rtHz") && !html.contains("m/s2"));
    let line = &d.converter.unwrap().line;
    let [tau, deviation] = line[0];
    assert!((tau - 0.02).abs() < 1e-12 && (deviation / (0.01 / 12f64.sqrt()) - 1.0).abs() < 1e-12);
    assert!((line[1][1] / deviation - (tau / line[1][0]).sqrt()).abs() < 1e-12);
    // A reading in fifty is another one: noise far below a step.
    let hidden: Vec<i64> = codes(5000).iter().map(|c| i64::from(*c > 104)).collect();
    let (html, svg, d) = page(&hidden);
    assert!(!svg.contains("rounding of the converter"));
    assert!(html.contains("take no dwell from it"), "{:?}", d.dwell);
    assert!(d.converter.unwrap().line.is_empty());
}

/// Bound of the memory, kB: window and levels of the streams (docs/noise.md), the program itself.
const MOST_MEMORY_KB: u64 = 100_000;

/// 10⁸ readings (10⁶ in the short tier) through a file, memory watched.
#[test]
fn memory_does_not_grow_with_the_record() {
    let long = std::env::var_os("TUMBLE_LONG").is_some();
    let blocks = if long { 1000 } else { 10 };
    let dir = tempfile::tempdir().unwrap();
    let path: PathBuf = dir.path().join("long.csv");
    let mut file = std::io::BufWriter::new(std::fs::File::create(&path).unwrap());
    for block in 0..blocks {
        // Every block anew: a record that repeats would be no noise.
        let mut state = 7 + 1000 * block as u64;
        let mut text = String::with_capacity(400_000);
        for _ in 0..100_000 {
            state = 16_807 * state % 2_147_483_647;
            let _ = writeln!(text, "{}", state % 37);
        }
        file.write_all(text.as_bytes()).unwrap();
    }
    file.into_inner().unwrap().sync_all().unwrap();
    let args =
        ["noise", "long.csv", "--rate", "100", "--json", "--deviation", "allan,modified,hadamard"];
    let started = std::time::Instant::now();
    let child = Command::new(env!("CARGO_BIN_EXE_tumble"))
        .args(args)
        .current_dir(dir.path())
        .stdout(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let status = format!("/proc/{}/status", child.id());
    let watch = std::thread::spawn(move || {
        let mut peak = 0;
        while let Ok(text) = std::fs::read_to_string(&status) {
            let own = text.lines().find_map(|l| l.strip_prefix("VmHWM:"));
            let Some(kb) = own.and_then(|l| l.trim().trim_end_matches("kB").trim().parse().ok())
            else {
                break;
            };
            peak = u64::max(peak, kb);
            std::thread::sleep(std::time::Duration::from_millis(2));
        }
        peak
    });
    let o = child.wait_with_output().unwrap();
    let peak = watch.join().unwrap();
    assert_eq!(o.status.code(), Some(0));
    let d: NoiseDocument = serde_json::from_slice(&o.stdout).unwrap();
    assert_eq!(d.input.readings, 100_000 * blocks as u64);
    println!("{} readings: {peak} kB, {:.1?}", d.input.readings, started.elapsed());
    // Where /proc is not there, nothing was seen.
    assert!(peak < MOST_MEMORY_KB, "{peak} kB");
}
