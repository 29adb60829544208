//! Whatever stands in a file: an answer or a refusal that names it, never a panic.
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.

use proptest::prelude::*;
use tumble_io::passport::Passport;
use tumble_io::{CertifyOptions, CodeStream, certify};

const TOML: &str = "[sensor]\nserial = \"x\"\n[output]\nquantizer = \"truncate\"\nnominal_scale = 0.0077\n\
                    [bench]\ngravity = 9.81\nangle_uncertainty_arcmin = 1.0\n[[run]]\nfile = \"run.csv\"\n";

/// Pieces that CSV files are made of, in any order.
fn pieces() -> impl Strategy<Value = Vec<u8>> {
    let piece = prop_oneof![
        8 => Just("angle_deg,code\n".to_owned()),
        4 => Just("angle_deg,mean_code,samples,std_code\n".to_owned()),
        2 => Just("angle_deg;code;temperature_degc\n".to_owned()),
        20 => (-91.0..91.0f64, -3000..3000i32).prop_map(|(a, n)| format!("{a:.1},{n}\n")),
        6 => (-91.0..91.0f64, -3000.0..3000.0f64, 0..9u32, -1.0..3.0f64)
            .prop_map(|(a, m, n, s)| format!("{a:.1},{m},{n},{s}\n")),
        2 => any::<f64>().prop_map(|x| format!("{x:?},{x:?}\n")),
        2 => Just("\"".to_owned()),
        1 => Just(",,;;\t\r\n#\u{feff}\n".to_owned()),
        2 => "\\PC{0,12}",
    ];
    prop::collection::vec(piece, 0..40).prop_map(|p| p.concat().into_bytes())
}

/// A line of `[spec]`: right, wrong, or far too large.
fn spec_line() -> impl Strategy<Value = String> {
    let number = || {
        prop_oneof![
            4 => (-3.0..3.0f64).prop_map(|x| format!("{x:?}")),
            1 => (-300..300i32).prop_map(|e| format!("1e{e}")),
            1 => prop::sample::select(vec!["inf", "-inf", "nan", "0", "-0.0", "7", "\"1 mg\""])
                .prop_map(str::to_owned),
        ]
    };
    let key = prop::sample::select(vec![
        "bias_limits_m_s2",
        "bias_limits_mg",
        "misalignment_limits_rad",
        "misalignment_limits_arcmin",
        "scale_error_limits",
        "scale_error_limits_percent",
        "scale_error_limits_ppm",
        "scale_factor_limits",
        "prior_bias_m_s2",
        "prior_scale_factor",
        "guard_band",
        "decision_rule",
    ]);
    let rule = prop::sample::select(vec!["simple", "guarded", "non-binary", ""]);
    prop_oneof![
        6 => (key.clone(), number(), number()).prop_map(|(k, a, b)| format!("{k} = [{a}, {b}]\n")),
        3 => (key, number()).prop_map(|(k, a)| format!("{k} = {a}\n")),
        1 => rule.prop_map(|r| format!("decision_rule = \"{r}\"\n")),
    ]
}

fn judged(toml: &str, csv: &[u8]) {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("experiment.toml"), toml).unwrap();
    std::fs::write(dir.path().join("run.csv"), csv).unwrap();
    match certify(dir.path(), &CertifyOptions::default()) {
        Ok(p) => {
            let json = p.to_json().unwrap();
            assert_eq!(Passport::from_json(&json).unwrap().verdict, p.verdict);
            // One run is never enough, and nonsense less so.
            assert_ne!(p.verdict, "accepted");
        }
        Err(e) => assert!(!e.to_string().is_empty()),
    }
}

/// Dwells that one run's result follows from.
const DWELLS: &str = "angle_deg,mean_code,samples,std_code\n-60,-1103.6,100,0.5\n-40,-819.9,100,0.5\n\
                      -20,-436.2,100,0.5\n0,0.4,100,0.5\n20,436.1,100,0.5\n40,819.4,100,0.5\n60,1104.1,100,0.5\n\
                      70,1197.5,100,0.5\n-70,-1197.1,100,0.5\n";

#[test]
fn the_dwells_reach_the_decision() {
    let dir = tempfile::tempdir().unwrap();
    let toml = format!("{TOML}[spec]\nbias_limits_m_s2 = 1.0\n");
    std::fs::write(dir.path().join("experiment.toml"), toml).unwrap();
    std::fs::write(dir.path().join("run.csv"), DWELLS).unwrap();
    let passport = certify(dir.path(), &CertifyOptions::default()).unwrap();
    assert_eq!(passport.conformity.status, "pass", "{:?}", passport.missing);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn run_files_of_any_make(csv in pieces()) {
        judged(TOML, &[b"angle_deg,code\n".to_vec(), csv.clone()].concat());
        judged(TOML, &csv);
    }

    #[test]
    fn run_files_of_any_bytes(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        judged(TOML, &bytes);
        judged(TOML, &[&[0x1f, 0x8b, 8, 0][..], &bytes].concat());
    }

    #[test]
    fn experiment_files_of_any_text(text in "\\PC{0,200}", at in 0..200usize) {
        let cut = TOML.char_indices().map(|(i, _)| i).nth(at).unwrap_or(TOML.len());
        judged(&format!("{}{text}{}", &TOML[..cut], &TOML[cut..]), b"angle_deg,code\n0,1\n");
    }

    #[test]
    fn limits_of_any_make(lines in prop::collection::vec(spec_line(), 0..6)) {
        let toml = format!("{TOML}[spec]\n{}", lines.concat());
        judged(&toml, DWELLS.as_bytes());
    }

    #[test]
    fn streams_and_passports_of_any_bytes(bytes in prop::collection::vec(any::<u8>(), 0..300), whole in any::<bool>()) {
        if let Ok(mut stream) = CodeStream::new(&bytes[..], "x", whole) {
            while let Ok(Some(_)) = stream.next_reading() {}
        }
        let _ = Passport::from_json(&String::from_utf8_lossy(&bytes));
    }
}
