//! Angles of a run from a short text.

/// The paper's plan: sixty angles in 1° steps.
const PAPER_FIRST_DEG: i32 = -30;
const PAPER_LAST_DEG: i32 = 29;
/// Most angles of a plan: what an experiment's file may hold.
const MOST_ANGLES: u32 = 10_000;
/// No dial counts farther: a thousand turns.
const FARTHEST_DEG: f64 = 360_000.0;

/// A plan that is not understood.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlanError {
    /// The text, or the part of it, that is not understood.
    pub text: String,
}

impl std::fmt::Display for PlanError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        // Whatever was typed, safe to print on a terminal.
        let visible = |c: char| if c.is_control() { '\u{fffd}' } else { c };
        let text: String = self.text.chars().take(80).map(visible).collect();
        write!(
            f,
            "`{text}` is no plan: write FIRST:LAST:COUNT (-65:65:60, at most {MOST_ANGLES}), a list of degrees (-65,0,65), or paper"
        )
    }
}

impl std::error::Error for PlanError {}

/// Table angles in degrees from `FIRST:LAST:COUNT` (equal steps, both ends included), a comma-separated list, or
/// `paper` (−30…29° in 1° steps).
///
/// ```
/// use tumble_core::simulate::parse_plan;
/// assert_eq!(parse_plan("-65:65:3")?, [-65.0, 0.0, 65.0]);
/// assert_eq!(parse_plan("-20, 7.5")?, [-20.0, 7.5]);
/// assert_eq!(parse_plan("paper")?.len(), 60);
/// assert!(parse_plan("-65:65").is_err());
/// assert!(parse_plan("-65:65:4000000000").is_err());
/// assert!(!parse_plan("\u{1b}[2J").unwrap_err().to_string().contains('\u{1b}'));
/// assert!(parse_plan("-1e308:1e308:3").is_err());
/// # Ok::<(), tumble_core::simulate::PlanError>(())
/// ```
pub fn parse_plan(text: &str) -> Result<Vec<f64>, PlanError> {
    let wrong = |part: &str| PlanError { text: part.to_owned() };
    let number = |part: &str| {
        let value = part.trim().parse::<f64>().ok();
        value.filter(|v| v.abs() <= FARTHEST_DEG).ok_or_else(|| wrong(part))
    };
    if text.trim() == "paper" {
        return Ok((PAPER_FIRST_DEG..=PAPER_LAST_DEG).map(f64::from).collect());
    }
    let parts: Vec<&str> = text.split(':').collect();
    match parts[..] {
        [first, last, count] => {
            let (first, last) = (number(first)?, number(last)?);
            let n: u32 = count.trim().parse().map_err(|_| wrong(count))?;
            match n {
                0 => Err(wrong(text)),
                _ if n > MOST_ANGLES => Err(wrong(count)),
                1 => Ok(vec![first]),
                _ => Ok((0..n)
                    .map(|i| first + (last - first) * f64::from(i) / f64::from(n - 1))
                    // Angles are typed; four decimals are 0.4 seconds of arc.
                    .map(|a| (a * 1e4).round() / 1e4)
                    .collect()),
            }
        }
        [list] => list.split(',').map(number).collect(),
        _ => Err(wrong(text)),
    }
}
