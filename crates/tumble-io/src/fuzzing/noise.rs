//! Records of `tumble noise`.

use tumble_core::noise::{Deviation, Spacing, Times};

use super::files::Drip;
use super::{digit, said};
use crate::error::Place;
use crate::noise::{
    NoiseDocument, NoiseFailure, NoiseSettings, Scale, TimeUnit, analyse_text, from_json,
};

/// How a record is read, by two bytes.
fn settings([a, b]: [u8; 2]) -> NoiseSettings {
    let mut n = u32::from_le_bytes([a, b, 0, 0]);
    let columns = [None, None, Some("2"), Some("acc")];
    let column = columns[digit(&mut n, 4) as usize].map(ToOwned::to_owned);
    let rate_hz = [Some(100.0), None, Some(1e-6), Some(1e9)][digit(&mut n, 4) as usize];
    let times = [None, None, Some("1"), Some("time")];
    let time = times[digit(&mut n, 4) as usize].map(ToOwned::to_owned);
    let time_unit = TimeUnit::ALL.get(digit(&mut n, 8) as usize).copied();
    let scales = [None, Some(1.0), Some(1e-12), Some(1e12)];
    let scale = scales[digit(&mut n, 4) as usize]
        .map(|m_s2_per_unit| Scale { m_s2_per_unit, source: "as given".into() });
    let (deviations, times) = match digit(&mut n, 5) {
        0 => (Vec::new(), Times::Spaced(Spacing::Octave)),
        1 => (vec![Deviation::Modified, Deviation::Hadamard], Times::Spaced(Spacing::Octave)),
        2 => (vec![Deviation::Hadamard], Times::Spaced(Spacing::Decade)),
        3 => (vec![Deviation::Total, Deviation::Modified], Times::Spaced(Spacing::Decade)),
        _ => (Vec::new(), Times::All),
    };
    NoiseSettings { column, rate_hz, time, time_unit, scale, deviations, times, level: 0.683 }
}

/// What every document keeps to.
fn sound(d: &NoiseDocument) {
    let json = d.to_json().expect("a document can be written");
    let place = Place::file("noise.json");
    let again = from_json(json.as_bytes(), &place).expect("numbers are numbers: it reads again");
    assert_eq!(again, *d);
    assert_eq!(d.input.pieces.iter().sum::<u64>(), d.input.readings);
    assert!(d.input.rate_hz > 0.0 && d.standard_deviation >= 0.0);
    assert!(d.extremes[0] < d.extremes[1]);
    assert!(!d.curves.is_empty());
    for p in d.curves.iter().flat_map(|c| &c.points) {
        assert!(p.deviation >= 0.0 && p.tau_s > 0.0 && p.terms > 0, "{p:?}");
        if let Some([low, high]) = p.band {
            // With one degree of freedom the deviation lies below its own band at some levels.
            assert!(0.0 <= low && low <= high, "{p:?}");
        }
    }
    for c in d.fit.iter().flat_map(|f| &f.coefficients) {
        assert!(c.value >= 0.0 && c.interval.0 <= c.value, "{c:?}");
        assert!(c.interval.1.is_none_or(|high| high >= c.value), "{c:?}");
    }
    d.remarks.iter().for_each(|r| drop(said(r)));
    match d.known("noise.json") {
        Ok(known) => assert!(d.unit == "m/s2" && known.white_m_s2_rts >= 0.0),
        Err(e) => drop(said(&e)),
    }
}

/// Records: the first two bytes say how they are read. Whole and in drops the same document, or the same refusal.
pub fn noise_record(data: &[u8]) {
    let Some((how, text)) = data.split_first_chunk::<2>() else { return };
    let settings = settings(*how);
    let read = |in_drops: bool| -> Result<NoiseDocument, NoiseFailure> {
        match in_drops {
            true => analyse_text(Drip::new(text), "still.csv", &settings),
            false => analyse_text(text, "still.csv", &settings),
        }
    };
    match (read(false), read(true)) {
        (Ok(a), Ok(b)) => {
            assert_eq!(a, b);
            sound(&a);
        }
        (Err(a), Err(b)) => assert_eq!(said(&a), said(&b)),
        (a, b) => panic!("whole: {a:?}, in drops: {b:?}"),
    }
}
