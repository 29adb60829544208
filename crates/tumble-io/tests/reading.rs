//! Nothing is misread: what is understood is read right, the rest is refused with file, line, column and remedy.
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.

use std::io::Write as _;
use std::path::Path;

use tumble_io::{ExperimentFolder, read_experiment};

const TOML: &str = "[sensor]\nserial = \"x\"\n[output]\nquantizer = \"round\"\nnominal_scale = 0.0077\nrate_hz = 2.0\n\
                    [bench]\ngravity = 9.81\n[[run]]\nfile = \"run.csv\"\n";

fn folder(toml: &str, csv: &[u8]) -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("experiment.toml"), toml).unwrap();
    std::fs::write(dir.path().join("run.csv"), csv).unwrap();
    dir
}

fn read(toml: &str, csv: impl AsRef<[u8]>) -> ExperimentFolder {
    let dir = folder(toml, csv.as_ref());
    read_experiment(dir.path(), &()).unwrap()
}

fn refusal(toml: &str, csv: impl AsRef<[u8]>) -> String {
    let dir = folder(toml, csv.as_ref());
    read_experiment(dir.path(), &()).unwrap_err().to_string()
}

/// Angle, mean and samples of each dwell.
fn dwells(f: &ExperimentFolder) -> Vec<(f64, f64, u64)> {
    f.experiment.runs[0]
        .positions
        .iter()
        .map(|p| {
            ((p.angle.deg() * 1e9).round() / 1e9, p.readings.mean().unwrap(), p.readings.samples())
        })
        .collect()
}

fn gz(bytes: &[u8]) -> Vec<u8> {
    let mut e = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    e.write_all(bytes).unwrap();
    e.finish().unwrap()
}

#[test]
fn one_record_in_many_dresses() {
    let plain = "angle_deg,code\n-30,10\n-30,12\n30,-7\n";
    let expected = dwells(&read(TOML, plain));
    assert_eq!(expected, [(-30.0, 11.0, 2), (30.0, -7.0, 1)]);
    let dresses: Vec<Vec<u8>> = vec![
        plain.replace('\n', "\r\n").into_bytes(),
        format!("\u{feff}# logger 3\n\n{plain}\n# end\n").into_bytes(),
        plain.replace(',', ";").into_bytes(),
        plain.replace(',', "\t").into_bytes(),
        b"angle_deg;code\n-30,0;10\n-30,00;12\n30,0;-7".to_vec(),
        b"code,angle_deg\n10,-30\n12,-30.0\n-7,30\n".to_vec(),
        b"\"angle_deg\",\"code\"\n\"-30\", 10\n -30,\"12\"\n30,-7.000\n".to_vec(),
        gz(plain.as_bytes()),
        [gz(b"angle_deg,code\n-30,10\n"), gz(b"-30,12\n30,-7\n")].concat(),
    ];
    for dress in dresses {
        assert_eq!(dwells(&read(TOML, &dress)), expected, "{}", String::from_utf8_lossy(&dress));
    }
}

#[test]
fn repeats_of_one_angle_are_told_apart_by_position() {
    let f = read(TOML, "angle_deg,code,position\n0,1,a\n0,3,a\n0,5,b\n");
    assert_eq!(dwells(&f), [(0.0, 2.0, 2), (0.0, 5.0, 1)]);
}

#[test]
fn dial_sign_zero_and_orientation() {
    let toml =
        TOML.replace("gravity = 9.81", "gravity = 9.81\nangle_sign = -1\nangle_zero_deg = 5.0");
    let f = read(&toml, "angle_deg,code\n35,1\n");
    assert_eq!(dwells(&f)[0].0, -30.0);
    let f = read(
        &format!("{TOML}orientation = \"reversed\"\nmounting = \"B\"\n"),
        "angle_deg,code\n30,1\n",
    );
    let run = &f.experiment.runs[0];
    let seating = run.orientation.seating(&run.mounting);
    assert_eq!((dwells(&f)[0].0, seating.as_str()), (-30.0, "B reversed"));
}

#[test]
fn the_start_of_a_dwell_is_thrown_away_by_rate_or_by_time() {
    let csv = "angle_deg,code\n0,100\n0,100\n0,1\n0,3\n5,100\n5,100\n5,7\n";
    let by_rate = read(&format!("{TOML}discard_s = 1.0\n"), csv);
    assert_eq!(dwells(&by_rate), [(0.0, 2.0, 2), (5.0, 7.0, 1)]);
    let csv = "t_s,angle_deg,code\n10.0,0,100\n10.9,0,100\n11.0,0,1\n";
    let by_time = read(&format!("{TOML}discard_s = 1.0\n"), csv);
    assert_eq!(dwells(&by_time), [(0.0, 1.0, 1)]);
}

#[test]
fn own_headers_one_file_an_angle_and_real_readings() {
    let mapped = format!("{TOML}columns = {{angle_deg = \"Winkel\", code = \"ADC\"}}\n");
    assert_eq!(dwells(&read(&mapped, "ADC;Winkel\n4;1,5\n")), [(1.5, 4.0, 1)]);
    let files =
        TOML.replace("file = \"run.csv\"", "files = [{file = \"run.csv\", angle_deg = -12.5}]");
    assert_eq!(dwells(&read(&files, "code\n4\n6\n")), [(-12.5, 5.0, 2)]);
    let volts = TOML.replace("\"round\"", "\"none\"\nunit = \"V\"");
    assert_eq!(dwells(&read(&volts, "angle_deg,output\n0,0.25\n0,0.75\n")), [(0.0, 0.5, 2)]);
}

#[test]
fn what_is_not_understood_is_refused_with_its_place_and_a_remedy() {
    // CSV, and what the message must name.
    let cases: &[(&str, &[&str])] = &[
        ("", &["run.csv", "header line"]),
        ("angle_deg,code\n", &["no rows"]),
        (
            "Angle,ADC\n0,1\n",
            &["line 1", "angle_deg", "columns = {angle_deg = \"Angle\", code = \"ADC\"}"],
        ),
        ("angle_deg,code,code\n0,1,2\n", &["`code` occurs twice"]),
        ("angle_deg,code\n0,1\n0,1.5\n", &["line 3", "column code", "`1.5`", "mean_code"]),
        ("angle_deg,code\n0,0x1f\n", &["line 2", "integer"]),
        ("angle_deg,code\n0,\n", &["line 2", "column code"]),
        ("angle_deg,code\n0,NaN\n", &["`NaN`"]),
        ("angle_deg,code\n0,1,2\n", &["line 2", "3 fields", "header has 2"]),
        ("angle_deg,code\n0,1\n5", &["line 3", "truncated"]),
        ("angle_deg,code\n1,234.5,7\n", &["3 fields"]),
        ("angle_deg;code\n1.234,5;7\n", &["decimal point"]),
        ("angle_deg,code\n12:30,7\n", &["line 2", "column angle_deg", "angle_unit = \"dms\""]),
        ("angle_deg,code\ntwelve,7\n", &["line 2", "column angle_deg"]),
        ("angle_deg,code\n0,99999999999\n", &["integer code"]),
        ("angle_deg,mean_code\n0,1.5\n", &["`samples`"]),
        ("angle_deg,mean_code,samples\n0,1.5,0\n", &["positive number of samples"]),
        ("angle_deg;mean_code;samples\n0;1,5;1.000\n", &["positive number of samples"]),
        ("angle_deg,mean_code,samples,std_code\n0,1.5,9,-1\n", &["standard deviation"]),
        ("angle_deg,output\n0,1.5\n", &["`code`"]),
        ("\u{1b}[2Jangle,\u{1b}]0;x\n1,2\n", &["no column"]),
    ];
    for (csv, expected) in cases {
        let text = refusal(TOML, csv);
        for word in *expected {
            assert!(text.contains(word), "{csv:?}: `{text}` does not name `{word}`");
        }
        assert!(!text.chars().any(char::is_control), "{csv:?}: {text:?}");
    }
    for (bytes, word) in [
        (&b"PK\x03\x04...."[..], "Excel"),
        (&b"PAR1...."[..], "Parquet"),
        (&b"\xff\xfea\x00n\x00"[..], "UTF-16"),
        (&b"\x28\xb5\x2f\xfd..."[..], "zstd"),
        (&b"angle_deg\0,code\n"[..], "binary"),
        (&b"\x1f\x8b\x08\x00broken"[..], "run.csv"),
    ] {
        let text = refusal(TOML, bytes);
        assert!(text.contains(word), "{text}");
    }
}

#[test]
fn experiment_toml_is_checked_too() {
    let cases = [
        (TOML.replace("gravity = 9.81", ""), "gravity = 9.81"),
        (TOML.replace("9.81", "981.0"), "between 9.7 and 9.9"),
        (TOML.replace("\"round\"", "\"rond\""), "line 4"),
        (TOML.replace("nominal_scale", "nominal_scael"), "did you mean `nominal_scale`"),
        (TOML.replace("0.0077", "-1.0"), "positive"),
        (TOML.replace("run.csv", "../run.csv"), "leaves the experiment folder"),
        (TOML.replace("run.csv", "/etc/hostname"), "leaves the experiment folder"),
        (TOML.replace("run.csv", "absent.csv"), "absent.csv"),
        (format!("{TOML}[[run]]\nfile = \"run.csv\"\n"), "exactly one run"),
        (format!("format = 7\n{TOML}"), "newer version"),
        (TOML.replace("[[run]]\nfile = \"run.csv\"\n", ""), "[[run]]"),
        (format!("{TOML}discard_s = 60.0\n"), "less than the dwell"),
        (TOML.replace("gravity = 9.81", "latitude_deg = 50.0"), "height_m"),
        (format!("{TOML}[scale]\nup_mean_code = 1.0\n"), "[scale]"),
    ];
    for (toml, word) in cases {
        let text = refusal(&toml, "angle_deg,code\n0,1\n");
        assert!(text.contains(word), "`{text}` does not name `{word}`");
    }
    let empty = tempfile::tempdir().unwrap();
    assert!(
        read_experiment(empty.path(), &()).unwrap_err().to_string().contains("tumble simulate")
    );
    assert!(
        read_experiment(Path::new("/nonexistent"), &())
            .unwrap_err()
            .to_string()
            .contains("experiment.toml")
    );
}

#[cfg(unix)]
#[test]
fn links_out_of_the_folder_are_refused() {
    let outside = tempfile::tempdir().unwrap();
    std::fs::write(outside.path().join("secret.csv"), "angle_deg,code\n0,1\n").unwrap();
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("experiment.toml"), TOML).unwrap();
    std::os::unix::fs::symlink(outside.path().join("secret.csv"), dir.path().join("run.csv"))
        .unwrap();
    let text = read_experiment(dir.path(), &()).unwrap_err().to_string();
    assert!(text.contains("leaves the experiment folder"), "{text}");
}
