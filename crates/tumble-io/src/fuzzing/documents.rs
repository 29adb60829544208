//! experiment.toml, what `tumble init` writes, and passports.

use std::cell::OnceCell;

use tumble_core::assess::assess_without;
use tumble_core::estimate::EstimateOptions;

use super::{Scratch, said};
use crate::catalogue::Catalogue;
use crate::compensation::{Proof, compensator};
use crate::folder::{ExperimentFolder, read_described};
use crate::init::{InitFacts, draft_experiment};
use crate::passport::{self, Passport};

/// A raw run that nearly anything can be said about.
const RUN: &str = "angle_deg,code,t_s,temperature_degc,position,sensor\n\
                   -30,-640,0,20,a,A\n-30,-638,0.5,20,a,A\n-10,-220,1,20,b,A\n-10,-222,1.5,20,b,B\n\
                   10,225,2,21,c,A\n10,223,2.5,21,c,B\n30,640,3,21,d,A\n30,641,3.5,21,d,A\n";
const AVERAGED: &str =
    "angle_deg,mean_code,samples,std_code\n-30,-639.1,100,1.2\n0,3.2,100,1.1\n30,640.2,90,1.3\n";

thread_local! {
    /// The folder that every experiment.toml describes.
    static FOLDER: OnceCell<Scratch> = const { OnceCell::new() };
}

fn in_folder<T>(work: impl FnOnce(&Scratch) -> T) -> T {
    FOLDER.with(|cell| {
        work(cell.get_or_init(|| {
            let scratch = Scratch::new();
            scratch.write("run.csv", RUN.as_bytes());
            scratch.write("averaged.csv", AVERAGED.as_bytes());
            scratch.write("up.csv", b"code\n1280\n1281\n1280\n");
            scratch.write("down.csv", b"code\n-1280\n-1279\n-1280\n");
            scratch
        }))
    })
}

/// experiment.toml: read or refused with a reason; what is read can be judged, and its passport reads again.
pub fn experiment_toml(text: &[u8]) {
    in_folder(|scratch| match read_described(scratch.path(), text, None, &()) {
        Ok(read) => judged(&read),
        Err(e) => {
            said(&e);
        }
    });
}

/// Most positions that are judged here: judging is not what is fuzzed.
const JUDGED: usize = 40;

fn judged(read: &ExperimentFolder) {
    let positions: Vec<_> = read.experiment.runs.iter().flat_map(|r| &r.positions).collect();
    assert!(positions.iter().all(|p| p.angle.deg().abs() <= 180.0), "angles of half a turn");
    if positions.len() > JUDGED {
        return;
    }
    let options = EstimateOptions::default();
    match assess_without(&read.experiment, &options, &read.left_out) {
        Ok(assessment) => {
            let passport = passport::build(read, &assessment, &options, None, None);
            // `certify` refuses it.
            if !passport.is_finite() {
                return;
            }
            let json = passport.to_json().expect("a passport can be written");
            let again = Passport::from_json(&json).expect("what was written reads again");
            assert_eq!(again.to_json().expect("a passport can be written"), json);
        }
        Err(e) => {
            said(&e);
        }
    }
}

/// `tumble init`: what it writes is an experiment.toml that is read, or refused with a reason; the same twice.
pub fn init(csv: &[u8]) {
    let scratch = Scratch::new();
    let file = scratch.write("record.csv", csv);
    match draft_experiment(&[file], &InitFacts::default(), &()) {
        Ok(draft) => {
            let text = draft.toml.as_bytes();
            match (&draft.read, read_described(scratch.path(), text, None, &())) {
                (Ok(a), Ok(b)) => assert_eq!(*a, b),
                // Where no column of readings was found, the draft says so, and the reader misses its table.
                (Err(a), Err(b)) => {
                    said(a);
                    said(&b);
                }
                (a, b) => panic!("drafted as {a:?}, read as {b:?}"),
            }
            let is_toml = toml::from_str::<toml::Table>(&draft.toml);
            assert!(is_toml.is_ok(), "{is_toml:?}\n{}", draft.toml);
            draft.missing.iter().for_each(|m| {
                said(m);
            });
        }
        Err(e) => {
            said(&e);
        }
    }
}

/// passport.json: read or refused with a reason; what is read is written and read again; coefficients give numbers.
pub fn passport_json(data: &[u8]) {
    let text = String::from_utf8_lossy(data);
    let passport = match Passport::from_json(&text) {
        Ok(passport) => passport,
        Err(e) => {
            said(&e);
            return;
        }
    };
    let json = passport.to_json().expect("a passport can be written");
    assert_eq!(Passport::from_json(&json).expect("what was written reads again"), passport);
    for proof in [Proof::Required, Proof::Waived] {
        match compensator(&passport, proof) {
            Ok(compensator) => {
                for code in [-32768.0, -1.0, 0.0, 0.5, 1.0, 1234.0, 2_147_483_647.0] {
                    let Some(c) = compensator.compensate(code) else { continue };
                    for number in [c.acceleration_m_s2, c.u_calibration_m_s2, c.u_reading_m_s2] {
                        assert!(number.is_finite(), "{number} from {code}");
                    }
                }
            }
            Err(e) => {
                said(&e);
            }
        }
    }
}

/// A user's catalogue of sensor types: refused in words, or read the same way twice.
pub fn catalogue_toml(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    match (Catalogue::parse(text, "catalogue.toml"), Catalogue::parse(text, "catalogue.toml")) {
        (Ok(one), Ok(other)) => {
            assert_eq!(one.to_json(), other.to_json());
            let both = Catalogue::builtin().with(&one);
            one.sensors().iter().for_each(|e| assert!(both.find(e.model()).is_some()));
        }
        (Err(one), Err(other)) => assert_eq!(said(&one), said(&other)),
        _ => panic!("read once, refused once"),
    }
}
