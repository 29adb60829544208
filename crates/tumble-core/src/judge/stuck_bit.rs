//! A bit that never changes: missing codes, or words that stand at the wrong end.

use std::collections::BTreeSet;

use crate::{Finding, FindingKind, Output, Position, Quantizer, Readings};

/// Different codes from which a bit that never changes is no chance: 2⁻³⁹, were each a toss of a coin.
pub(crate) const FEWEST_CODES: usize = 40;
/// Periods of a bit that the codes must span.
const PERIODS: i64 = 16;

/// A low bit that is the same in all codes of a run.
///
/// Rounded words that end in two zeros or more are left in peace: converters of 12 or 14 bits deliver them in the upper
/// end of 16, and the mean is right. With `floor` and `truncate` it is off by half the true step all the same.
pub(super) fn stuck_bit(run: &str, positions: &[&Position], output: &Output) -> Option<Finding> {
    let mut codes: BTreeSet<i32> = BTreeSet::new();
    for p in positions {
        if let Readings::Codes { histogram, .. } = &p.readings {
            codes.extend(
                histogram
                    .bins()
                    .map(|(c, _)| c.0)
                    .filter(|c| !output.ends.censors(crate::Code(*c))),
            );
        }
    }
    let (lowest, highest) = (*codes.first()?, *codes.last()?);
    let span = i64::from(highest) - i64::from(lowest);
    if codes.len() < FEWEST_CODES {
        return None;
    }
    let always = codes.iter().fold(-1, |all, c| all & c);
    let never = codes.iter().fold(-1, |all, c| all & !c);
    let changes_not = |bit: u32| (always | never) >> bit & 1 == 1;
    let spanned = |bit: &u32| span >= PERIODS << (bit + 1);
    let first = (0..24).filter(spanned).find(|b| changes_not(*b))?;
    let zeros = (0..24).take_while(|b| never >> b & 1 == 1).count();
    if output.quantizer == Quantizer::Round && zeros > 1 {
        return None;
    }
    let value = if always >> first & 1 == 1 { "one" } else { "zero" };
    let step = 1i64 << zeros.max(1);
    Some(Finding {
        kind: FindingKind::StuckConverter,
        place: run.to_owned(),
        observed: format!(
            "bit {first} is {value} in all {} different codes from {lowest} to {highest}",
            codes.len()
        ),
        limit: format!("a bit that changes among {FEWEST_CODES} codes"),
        remedy: if zeros > 0 {
            format!(
                "if the words stand in the upper bits, divide the codes by {step} and give nominal_scale per true step; else check the converter's lines: a bit does not change; measure again with fresh samples"
            )
        } else {
            "check the converter's lines and the logger: a bit does not change; measure again with fresh samples".into()
        },
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Angle, BlockSums, Code, CodeHistogram, ConverterEnds, Record, Seat};

    fn found(quantizer: Quantizer, codes: impl Iterator<Item = i32>) -> Option<String> {
        let mut histogram = CodeHistogram::default();
        codes.for_each(|c| histogram.record(Code(c)));
        let position = Position {
            angle: Angle::from_deg(0.0),
            seat: Seat::Table,
            readings: Readings::Codes { histogram, blocks: BlockSums::default() },
            temperature_degc: None,
            place: String::new(),
            record: Record::default(),
        };
        let output = Output {
            quantizer,
            unit: "LSB".into(),
            nominal_scale_m_s2_per_lsb: None,
            rate_hz: None,
            ends: ConverterEnds::default(),
        };
        stuck_bit("run", &[&position], &output).map(|f| f.observed)
    }

    #[test]
    fn bits_that_do_not_change_are_named() {
        let bit = |q, codes: Vec<i32>| found(q, codes.into_iter()).unwrap_or_default();
        assert!(
            bit(Quantizer::Floor, (-50..50).map(|n| 2 * n).collect()).starts_with("bit 0 is zero")
        );
        assert!(
            bit(Quantizer::Round, (-50..50).map(|n| 2 * n + 1).collect())
                .starts_with("bit 0 is one")
        );
        assert!(
            bit(Quantizer::Floor, (-900..900).filter(|n| n & 4 == 0).collect())
                .starts_with("bit 2 is zero")
        );
        assert!(bit(Quantizer::Truncate, (-90..90).map(|n| 16 * n).collect()).starts_with("bit 0"));
    }

    #[test]
    fn honest_codes_are_left_in_peace() {
        assert_eq!(found(Quantizer::Floor, -50..50), None);
        // Twelve bits in the upper end of sixteen, rounded; a few codes; a high bit that a narrow range never changes.
        assert_eq!(found(Quantizer::Round, (-90..90).map(|n| 16 * n)), None);
        assert_eq!(found(Quantizer::Floor, (0..30).map(|n| 2 * n)), None);
        assert_eq!(found(Quantizer::Floor, 1000..1100), None);
    }
}
