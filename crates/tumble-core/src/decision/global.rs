//! Global risks: the share of wrong decisions over a production whose spread is known.

use super::Limits;
use crate::stats::normal_cdf;

/// What is known of a production before a unit of it is measured: a normal distribution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Production {
    mean: f64,
    standard_deviation: f64,
}

impl Production {
    /// A production; `None` unless the mean is finite and the standard deviation finite, above zero and more than a
    /// billionth of the mean.
    #[must_use]
    pub fn new(mean: f64, standard_deviation: f64) -> Option<Self> {
        let known = mean.is_finite()
            && standard_deviation.is_finite()
            && standard_deviation > 0.0
            && standard_deviation > 1e-9 * mean.abs();
        known.then_some(Self { mean, standard_deviation })
    }

    /// Mean over all units.
    #[must_use]
    pub fn mean(self) -> f64 {
        self.mean
    }

    /// Standard deviation over all units.
    #[must_use]
    pub fn standard_deviation(self) -> f64 {
        self.standard_deviation
    }
}

/// Shares of all units of a production that are decided wrongly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GlobalRisk {
    /// `R_C`: passed, and does not conform.
    pub consumer: f64,
    /// `R_P`: not passed, and conforms.
    pub producer: f64,
}

/// Standard deviations beyond which nothing is integrated: 1e-19 of the production lies there.
const REACH: i32 = 9;

/// Global risks of a rule with the given acceptance limits (`None`: nothing is accepted).
///
/// **Model** `R_C = ∫_{η ∉ T} φ((η−y₀)/u₀)/u₀ · P(A_L ≤ Y ≤ A_U | η) dη`, `R_P` the same over conforming `η` and values
/// outside of the acceptance limits; `Y | η` is normal with standard uncertainty `u` around `η`. It is the probability of
/// the corners of a bivariate normal distribution.
///
/// **Uncertainty** absolute error below 1e-13. The uncertainty is taken as known: degrees of freedom play no part.
///
/// **Source** JCGM 106:2012, clause 9.
#[must_use]
pub fn global_risk(
    limits: Limits,
    acceptance: Option<Limits>,
    production: Production,
    standard_uncertainty: f64,
) -> GlobalRisk {
    let Production { mean, standard_deviation } = production;
    let (lower, upper) = limits.ends();
    let reach = f64::from(REACH) * standard_deviation;
    let ends = (mean - reach, mean + reach);
    let mut cuts: Vec<f64> =
        (-REACH..=REACH).map(|i| mean + f64::from(i) * standard_deviation).collect();
    cuts.extend([lower, upper]);
    if let Some(a) = acceptance {
        // Where the probability of acceptance changes, panels are no wider than one uncertainty.
        for limit in a.lower().into_iter().chain(a.upper()) {
            cuts.extend((-REACH..=REACH).map(|i| limit + f64::from(i) * standard_uncertainty));
        }
    }
    cuts.retain(|x| ends.0 <= *x && *x <= ends.1);
    cuts.sort_by(f64::total_cmp);
    let accepted = |eta: f64| {
        acceptance.map_or(0.0, |a| {
            if standard_uncertainty <= 0.0 {
                return f64::from(u8::from(a.contain(eta)));
            }
            let (low, high) = a.ends();
            let z = |limit: f64| (limit - eta) / standard_uncertainty;
            normal_cdf(z(high)) - normal_cdf(z(low))
        })
    };
    let density = |eta: f64| {
        let z = (eta - mean) / standard_deviation;
        (-0.5 * z * z).exp() / (core::f64::consts::TAU.sqrt() * standard_deviation)
    };
    let (mut consumer, mut producer) = (0.0, 0.0);
    for panel in cuts.windows(2) {
        let (from, to) = (panel[0], panel[1]);
        // A panel lies on one side of each limit, for the limits are cuts.
        if limits.contain(0.5 * (from + to)) {
            producer += gauss_legendre(from, to, |eta| density(eta) * (1.0 - accepted(eta)));
        } else {
            consumer += gauss_legendre(from, to, |eta| density(eta) * accepted(eta));
        }
    }
    GlobalRisk { consumer: consumer.clamp(0.0, 1.0), producer: producer.clamp(0.0, 1.0) }
}

/// Gauss–Legendre rule of ten points.
fn gauss_legendre(from: f64, to: f64, f: impl Fn(f64) -> f64) -> f64 {
    /// Positive nodes and their weights (numpy 2, `leggauss(10)`).
    const RULE: [(f64, f64); 5] = [
        (0.148_874_338_981_631_22, 0.295_524_224_714_752_8),
        (0.433_395_394_129_247_2, 0.269_266_719_309_996_5),
        (0.679_409_568_299_024_4, 0.219_086_362_515_982),
        (0.865_063_366_688_984_5, 0.149_451_349_150_580_4),
        (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
    ];
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    RULE.iter().map(|(x, w)| w * (f(middle - half * x) + f(middle + half * x))).sum::<f64>() * half
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `(y₀, u₀, u, T, A)` → `(R_C, R_P)` by scipy 1.17.1 `integrate.quad` with break points.
    #[test]
    fn global_risks_of_scipy() {
        const INF: f64 = f64::INFINITY;
        type Case = ([f64; 3], [f64; 2], [f64; 2], [f64; 2]);
        let cases: [Case; 7] = [
            // With and without a guard band; the bivariate normal distribution
            // (scipy `multivariate_normal.cdf`) gives 0.018942206717 and 0.037207800178 for the first.
            (
                [1500.0, 0.12, 0.04],
                [1499.8, 1500.2],
                [1499.8, 1500.2],
                [0.018_942_206_717_022_2, 0.037_207_800_178_028_355],
            ),
            (
                [1500.0, 0.12, 0.04],
                [1499.8, 1500.2],
                [1499.88, 1500.12],
                [0.000_468_633_598_872_667_9, 0.247_669_640_200_572_58],
            ),
            (
                [0.05, 0.1, 0.02],
                [-0.25, 0.25],
                [-0.21, 0.21],
                [8.656_831_693_877_537e-5, 0.039_712_495_354_976_37],
            ),
            (
                [0.0, 1.0, 0.5],
                [-INF, 1.5],
                [-INF, 1.0],
                [0.003_889_723_197_853_723_3, 0.122_629_206_690_344_44],
            ),
            (
                [0.1, 1.0, 1e-3],
                [-2.0, 2.0],
                [-1.998, 1.998],
                [9.299_502_855_862_554e-7, 0.000_220_672_110_726_939_87],
            ),
            ([0.0, 0.01, 0.3], [-1.0, 1.0], [-0.4, 0.4], [0.0, 0.182_665_334_852_471_44]),
            (
                [3.0, 1.0, 0.2],
                [-2.0, 2.0],
                [-2.0, 2.0],
                [0.021_674_868_804_746_21, 0.016_930_524_402_341_52],
            ),
        ];
        let between = |[lower, upper]: [f64; 2]| {
            let finite = |v: f64| v.is_finite().then_some(v);
            Limits::new(finite(lower), finite(upper)).unwrap()
        };
        for ([mean, sd, u], t, a, [consumer, producer]) in cases {
            let production = Production::new(mean, sd).unwrap();
            let ours = global_risk(between(t), Some(between(a)), production, u);
            // Ours and quad's absolute errors together (the limits around 1500 have ulps of 2e-13).
            assert!((ours.consumer - consumer).abs() < 2e-12, "{t:?}: {ours:?}");
            assert!((ours.producer - producer).abs() < 2e-12, "{t:?}: {ours:?}");
        }
    }

    /// Deaver's figures (Guardbanding with confidence, NCSL 1994), printed to three or four places, for a production of
    /// standard deviation 1, as the tests of Suncal (Sandia National Laboratories) quote them.
    #[test]
    fn global_risks_of_deaver() {
        let production = Production::new(0.0, 1.0).unwrap();
        for (limit, u, factor, consumer, producer) in [
            (2.0, 0.25, 1.0, 0.0080, Some(0.015)),
            (2.5, 0.25, 1.0, 0.0025, None),
            (2.0, 0.5, 0.91, 0.008, Some(0.066)),
        ] {
            let limits = Limits::new(Some(-limit), Some(limit)).unwrap();
            let acceptance = Limits::new(Some(-factor * limit), Some(factor * limit));
            let ours = global_risk(limits, acceptance, production, u);
            assert!((ours.consumer - consumer).abs() < 5e-4, "{limit}: {ours:?}");
            assert!(producer.is_none_or(|p: f64| (ours.producer - p).abs() < 5e-4), "{ours:?}");
        }
    }

    #[test]
    fn nothing_accepted_rejects_all_that_conforms() {
        let limits = Limits::new(Some(-1.0), Some(1.0)).unwrap();
        let risk = global_risk(limits, None, Production::new(0.0, 1.0).unwrap(), 5.0);
        assert_eq!(risk.consumer, 0.0);
        assert!((risk.producer - 0.682_689_492_137_085_9).abs() < 1e-13);
        // A measurement without uncertainty is never wrong.
        let exact = global_risk(limits, Some(limits), Production::new(0.0, 1.0).unwrap(), 0.0);
        assert_eq!((exact.consumer, exact.producer), (0.0, 0.0));
    }
}
