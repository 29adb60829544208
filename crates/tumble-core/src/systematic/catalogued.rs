//! What a data sheet's limits mean as uncertainties: nonlinearity as K2 and K3, temperature coefficients.

use super::quantity::{Quantity, Shape};
use super::{Input, Systematics};
use crate::sensor_type::axis_letter;
use crate::{
    LimitOf, Mark, Output, STANDARD_GRAVITY_M_S2, Sensor, SensorMode, SensorType, TypeLimit,
};

/// Default of u(K2) without a catalogue's entry: 100 µg/g², (m/s²)/(m/s²)².
///
/// **Source** method section 8: what shifts the bias of the paper's sensor by 0.13–0.24 LSB and leaves less than 0.01 LSB
/// in the residuals. A convention of this program, not a measured value: small for a MEMS sensor, of the size of a good
/// quartz pendulum.
pub const DEFAULT_K2_PER_M_S2: f64 = 100e-6 / STANDARD_GRAVITY_M_S2;
/// Default of u(K3): 100 µg/g³, (m/s²)/(m/s²)³; the same convention.
pub const DEFAULT_K3_PER_M2_S4: f64 = 100e-6 / (STANDARD_GRAVITY_M_S2 * STANDARD_GRAVITY_M_S2);

/// K2, K3 and temperature coefficients of an experiment.
pub(super) fn lines(
    sensor: &Sensor,
    output: &Output,
    stated: &Systematics,
    nominal_scale_m_s2_per_lsb: f64,
) -> Vec<Input> {
    let sheet = sensor.kind.as_ref().map(|kind| {
        let mode = nearest(kind, &output.unit, nominal_scale_m_s2_per_lsb);
        Sheet { kind, mode, axis: axis_letter(&sensor.axis) }
    });
    let mut out: Vec<Input> = curvature(stated, sheet.as_ref()).into();
    out.extend(tempco(sheet.as_ref()));
    out
}

/// A type of sensor in the mode that it was used in.
struct Sheet<'a> {
    kind: &'a SensorType,
    mode: Option<&'a SensorMode>,
    axis: Option<char>,
}

/// A limit read as a standard uncertainty.
struct Read {
    value: f64,
    shape: Shape,
    source: String,
}

impl Sheet<'_> {
    /// The largest verified limit of a kind that may hold: its typical size as a standard uncertainty, else its maximum as the end
    /// of a rectangle.
    fn uncertainty(&self, of: LimitOf) -> Option<Read> {
        let mode = self.mode.map(|m| m.name.as_str());
        let size = |l: &TypeLimit| l.typical.or(l.maximum.map(|m| m / 3f64.sqrt()));
        let (value, limit) = self
            .kind
            .limits_for(of, self.axis, mode)
            // A number from memory may warn; no certificate rests on it.
            .filter(|l| l.mark == Mark::Verified)
            .filter_map(|l| Some((size(l)?, l)))
            .max_by(|a, b| a.0.total_cmp(&b.0))?;
        let (shown, word, shape) = match (limit.typical, limit.maximum) {
            (Some(t), _) => (t, "typical", Shape::Normal),
            (None, max) => (max?, "at most", Shape::Rectangular),
        };
        let source = format!(
            "catalogue, {}: {} {shown} {} {word} ({})",
            self.kind.model,
            of.name(),
            of.unit(),
            limit.mark.words()
        );
        Some(Read { value, shape, source })
    }
}

/// The mode whose sensitivity is nearest to the nominal scale; `None` where a converter stands in between.
fn nearest<'a>(kind: &'a SensorType, unit: &str, nominal_scale: f64) -> Option<&'a SensorMode> {
    let distance = |m: &SensorMode| {
        let own = m.nominal_scale_m_s2_per(unit)?;
        Some((nominal_scale / own).ln().abs()).filter(|d| d.is_finite())
    };
    kind.modes
        .iter()
        .filter_map(|m| Some((distance(m)?, m)))
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, m)| m)
}

/// K2 and K3.
///
/// **Model** a limit of `L` % of full scale over the range ±A with full scale A: the deviation from the best straight line
/// reaches `n = A L/100`. Bow and S are equally likely to be what it is, and share its variance: `n/√2` each. A bow `K2 a²`
/// is off its best line by `K2 A²/2`, an S `K3 a³` by `K3 A³/4`; so `K2 = √2 n/A²`, `K3 = 2√2 n/A³`.
fn curvature(stated: &Systematics, sheet: Option<&Sheet<'_>>) -> [Input; 2] {
    let limit = sheet.and_then(|s| {
        // Without a mode the narrowest range: the same share of it bends more.
        let range = s.mode.and_then(|m| m.range_gn);
        let narrowest = || s.kind.modes.iter().filter_map(|m| m.range_gn).reduce(f64::min);
        let a = range.or_else(narrowest)? * STANDARD_GRAVITY_M_S2;
        Some((a, s.uncertainty(LimitOf::Nonlinearity)?))
    });
    let line = |quantity, given: Option<f64>, of_limit: fn(f64, f64) -> f64, default, words| {
        let (standard_uncertainty, shape, source) = match (given, &limit) {
            (Some(u), _) => (u, Shape::Normal, "stated".to_owned()),
            (None, Some((a, read))) => {
                let n = a * read.value / 100.0;
                (of_limit(n, *a), read.shape, read.source.clone())
            }
            (None, None) => (default, Shape::Normal, format!("default: {words}")),
        };
        Input { quantity, standard_uncertainty, shape, source }
    };
    [
        line(
            Quantity::Quadratic,
            stated.k2_per_m_s2,
            |n, a| 2f64.sqrt() * n / (a * a),
            DEFAULT_K2_PER_M_S2,
            "100 µg/g², a convention where no data sheet is known",
        ),
        line(
            Quantity::Cubic,
            stated.k3_per_m2_s4,
            |n, a| 8f64.sqrt() * n / (a * a * a),
            DEFAULT_K3_PER_M2_S4,
            "100 µg/g³, a convention where no data sheet is known",
        ),
    ]
}

/// Bias and scale per kelvin.
fn tempco(sheet: Option<&Sheet<'_>>) -> [Input; 2] {
    let mg = STANDARD_GRAVITY_M_S2 * 1e-3;
    [
        (Quantity::BiasTempco, LimitOf::ZeroGTempco, mg),
        (Quantity::ScaleTempco, LimitOf::ScaleTempco, 0.01),
    ]
    .map(|(quantity, of, unit)| match sheet.and_then(|s| s.uncertainty(of)) {
        Some(read) => Input {
            quantity,
            standard_uncertainty: read.value * unit,
            shape: read.shape,
            source: read.source,
        },
        None => Input {
            quantity,
            standard_uncertainty: 0.0,
            shape: Shape::Normal,
            source: "not known: the catalogue has no temperature coefficient".into(),
        },
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SensitivityUnit;

    fn kind(typical: Option<f64>, maximum: Option<f64>) -> SensorType {
        let mode = |name: &str, range, sensitivity| SensorMode {
            name: name.into(),
            range_gn: Some(range),
            sensitivity,
            unit: SensitivityUnit::LsbPerG,
            mark: Mark::Verified,
            tolerance: None,
        };
        SensorType {
            model: "T".into(),
            source: String::new(),
            catalogue: "built-in".into(),
            ratiometric: false,
            modes: vec![mode("2", 2.0, 1000.0), mode("8", 8.0, 250.0)],
            limits: vec![TypeLimit {
                of: LimitOf::Nonlinearity,
                axes: None,
                mode: None,
                typical,
                maximum,
                mark: Mark::Verified,
                note: String::new(),
            }],
        }
    }

    #[test]
    fn a_limit_of_nonlinearity_is_the_peak_of_a_bow_and_of_an_s() {
        let kind = kind(Some(0.1), Some(9.0));
        let g = STANDARD_GRAVITY_M_S2;
        let sheet = |mode| Sheet { kind: &kind, mode, axis: None };
        let two = nearest(&kind, "LSB", g / 1000.0);
        let [k2, k3] = curvature(&Systematics::default(), Some(&sheet(two)));
        // 0.1 % of 2 g is 2 mg. K2 = √2 · 2 mg / 4 g², K3 = 2√2 · 2 mg / 8 g³: both 707 µg.
        let peak = (2e-3 * g) / 2f64.sqrt();
        let a = 2.0 * g;
        assert!((k2.standard_uncertainty * a * a / 2.0 / peak - 1.0).abs() < 1e-12);
        assert!((k3.standard_uncertainty * a * a * a / 4.0 / peak - 1.0).abs() < 1e-12);
        assert!((k2.standard_uncertainty * g * 1e6 - 707.1).abs() < 0.1);
        assert!(k2.source.contains("nonlinearity 0.1 % FS typical (verified"), "{}", k2.source);
        let eight = nearest(&kind, "LSB", g / 251.0);
        let [wide, _] = curvature(&Systematics::default(), Some(&sheet(eight)));
        assert!((wide.standard_uncertainty / k2.standard_uncertainty - 0.25).abs() < 1e-12);
        // Through an unknown converter: the narrowest range.
        assert_eq!(nearest(&kind, "V", g / 251.0), None);
        let [unknown, _] = curvature(&Systematics::default(), Some(&sheet(None)));
        assert_eq!(unknown.standard_uncertainty, k2.standard_uncertainty);
    }

    #[test]
    fn a_maximum_alone_is_the_end_of_a_rectangle_and_what_is_stated_goes_first() {
        let kind = kind(None, Some(0.3));
        let sheet = Sheet { kind: &kind, mode: None, axis: None };
        let read = sheet.uncertainty(LimitOf::Nonlinearity).unwrap();
        assert_eq!((read.shape, read.value), (Shape::Rectangular, 0.3 / 3f64.sqrt()));
        assert!(read.source.contains("0.3 % FS at most"));
        let stated = Systematics { k2_per_m_s2: Some(1e-6), ..Systematics::default() };
        let [k2, _] = curvature(&stated, Some(&sheet));
        assert_eq!((k2.standard_uncertainty, k2.source.as_str()), (1e-6, "stated"));
        let [k2, k3] = curvature(&Systematics::default(), None);
        assert_eq!(k2.standard_uncertainty, DEFAULT_K2_PER_M_S2);
        assert_eq!(k3.standard_uncertainty, DEFAULT_K3_PER_M2_S4);
        let [bias, scale] = tempco(Some(&sheet));
        assert_eq!([bias.standard_uncertainty, scale.standard_uncertainty], [0.0, 0.0]);
    }
}
