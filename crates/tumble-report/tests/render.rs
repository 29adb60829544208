//! What each kind of passport shows, and what it must not.

mod common;

use tumble_report::{figures, html, summary};

/// Words that stand only beside coefficients.
const COEFFICIENTS: [&str; 8] = [
    "scale factor",
    "Scale factor",
    "next power-up",
    "± U",
    "How to apply it",
    "k* =",
    "tumble compensate",
    "expanded uncertainty",
];

#[test]
fn accepted_shows_everything() {
    let p = common::accepted();
    assert_eq!(p.verdict, "accepted");
    let text = summary(&p);
    assert!(text.starts_with("ACCEPTED"), "{text}");
    assert!(text.contains("ADXL203, serial 3, axis X") && text.contains("next power-up"), "{text}");
    assert!(text.lines().all(|l| l.chars().count() <= 80), "{text}");
    assert!(!text.contains('−'), "signs are ASCII in the terminal: {text}");

    let names: Vec<_> = figures(&p).iter().map(|f| f.name).collect();
    assert_eq!(names, ["settling", "residuals", "intervals", "error-level"]);

    let page = html(&p);
    for words in [
        "Calibration passport, not an accredited certificate.",
        "ACCEPTED — ",
        "almost inseparable under this plan",
        "for the next estimate",
        "a = k* · (N + c(N)) − Δa",
        "tumble compensate passport.json",
        "Held out: with the coefficients of the other runs",
        "not assessed: no temperature was recorded",
        "SHA-256",
    ] {
        assert!(page.contains(words), "{words}");
    }
    for input in &p.inputs {
        assert!(page.contains(&input.sha256));
    }
    for finding in &p.findings {
        assert!(page.contains(&finding.id), "{}", finding.id);
    }
}

#[test]
fn conformity_is_shown_with_rule_and_risk() {
    let p = common::held_against_limits();
    assert_eq!((p.verdict.as_str(), p.conformity.status.as_str()), ("accepted", "fail"));
    let text = summary(&p);
    for words in [
        "conformity    FAIL - non-binary rule, guard band 1 U (95 %)",
        "  bias          fail: ",
        "m/s², limits 4.903325 to 5.88399",
        "  misalignment  pass: ",
        "arcmin, limits at most 60; risk ",
        "  scale factor  pass: ",
    ] {
        assert!(text.contains(words), "{words}\n{text}");
    }
    assert!(text.lines().all(|l| l.chars().count() <= 80), "{text}");
    assert!(!text.contains('−'), "{text}");
    let page = html(&p);
    for words in [
        "<h2>Conformity</h2>",
        ": non-binary rule, guard band 1 U (95 %).",
        "Acceptance limits",
        "at most 60",
        "Fail against data sheet: bias, misalignment, scale error and scale factor",
        "Over a production of mean 0 and standard deviation 0.200 (scale error, 1): ",
        "a unit out of its limits keeps its coefficients",
        "from a Student distribution",
    ] {
        assert!(page.contains(words), "{words}");
    }
    // A tampered passport: the verdict decides, not the presence of the numbers.
    let mut tampered = p.clone();
    tampered.verdict = "rejected".into();
    assert!(!html(&tampered).contains("Acceptance limits"));
    assert!(!summary(&tampered).contains("limits"));
    // Limits that could not be judged are not passed over in silence; without limits nothing is said.
    tampered.conformity.parameters.clear();
    tampered.conformity.reason = Some("the calibration is rejected".into());
    assert!(summary(&tampered).contains("conformity    not assessed: the calibration is rejected"));
    assert!(html(&tampered).contains("Not assessed against the limits of [spec]"));
    assert!(!summary(&common::accepted()).contains("conformity"));
}

#[test]
fn rejected_shows_no_coefficients() {
    let p = common::rejected();
    assert_eq!(p.verdict, "rejected");
    // A tampered passport: the verdict decides, not the presence of the numbers.
    let mut tampered = common::accepted();
    tampered.verdict = "rejected".into();
    let mut unknown = common::accepted();
    unknown.verdict = "fine".into();
    for p in [&p, &tampered, &unknown] {
        let (text, page) = (summary(p), html(p));
        let names: Vec<_> = figures(p).iter().map(|f| f.name).collect();
        assert_eq!(names, ["residuals"]);
        for words in COEFFICIENTS {
            assert!(!text.contains(words), "summary: {words}\n{text}");
            assert!(!page.contains(words), "html: {words}");
        }
        for run in &p.runs {
            let bias = run.estimates.bias.as_ref().map_or(0.0, |e| e.value);
            let digits = format!("{bias:.4}").replace('-', "");
            assert!(
                !page.contains(&digits) && !text.contains(&digits),
                "{digits} is a coefficient"
            );
        }
    }
    assert!(summary(&p).starts_with("REJECTED"));
    assert!(html(&p).contains("Report: why there is no calibration passport"));
    assert!(html(&p).contains("T0112"));
}

#[test]
fn one_run_says_so_in_large_letters() {
    let p = common::one_run();
    assert_eq!(p.verdict, "indeterminate");
    assert!(html(&p).contains(r#"<p class="loud">One run: reproducibility not shown</p>"#));
    assert!(html(&p).contains("--unproven"));
    assert!(summary(&p).contains("ONE RUN: REPRODUCIBILITY NOT SHOWN"));
    let held_out = &figures(&p)[3];
    assert!(held_out.caption.contains("no held-out level"), "{}", held_out.caption);
}

#[test]
fn incomplete_says_what_is_missing() {
    let p = common::least();
    let (text, page) = (summary(&p), html(&p));
    assert!(figures(&p).is_empty());
    assert!(
        text.starts_with("INDETERMINATE") && text.contains("there is no run on the table"),
        "{text}"
    );
    assert!(page.contains("There is no run on the table."));
    for words in COEFFICIENTS {
        assert!(!text.contains(words) && !page.contains(words), "{words}");
    }
}

#[test]
fn every_mounting_has_its_misalignment() {
    let p = common::two_mountings();
    assert_eq!(p.result.as_ref().unwrap().mountings.len(), 2);
    let page = html(&p);
    assert!(page.contains("Misalignment Δφ (A)") && page.contains("Misalignment Δφ (B)"));
    assert!(summary(&p).contains("(mounting B)"));
    let intervals = figures(&p).into_iter().find(|f| f.name == "intervals").unwrap();
    assert!(intervals.svg.contains("Misalignment, mounting A"));
}

#[test]
fn numbers_that_cannot_be_shown_are_said_to_be() {
    let mut p = common::accepted();
    p.nominal_scale_m_s2_per_lsb = f64::NAN;
    assert!(summary(&p).starts_with("INDETERMINATE"));
    assert!(html(&p).contains("is not finite"));
    assert!(figures(&p).is_empty());
}

#[test]
fn figures_share_no_class_and_no_id() {
    let figures = figures(&common::accepted());
    for f in &figures {
        let scope = format!("tumble-{}", f.name);
        let style = f.svg.split("<style>").nth(1).and_then(|s| s.split("</style>").next()).unwrap();
        for selectors in style.split('}').filter_map(|r| r.rsplit_once('{').map(|(s, _)| s)) {
            let selectors = selectors.rsplit('{').next().unwrap();
            assert!(
                selectors.split(',').all(|s| s.starts_with(&format!(".{scope} "))),
                "{selectors}"
            );
        }
        for id in f.svg.split(" id=\"").skip(1) {
            assert!(id.starts_with(&scope), "{id:.40}");
        }
        assert!(style.contains("prefers-color-scheme:dark"));
        assert!(
            f.svg.contains("role=\"img\"") && f.svg.contains("<title") && f.svg.contains("<desc")
        );
    }
}

#[test]
fn the_same_passport_gives_the_same_bytes() {
    let p = common::accepted();
    assert_eq!(html(&p), html(&p));
    assert_eq!(figures(&p), figures(&p));
}

#[test]
fn real_numbers_are_readings_and_no_codes() {
    let mut p = common::accepted();
    assert!(summary(&p).contains("code "), "{}", summary(&p));
    p.output.quantizer = "none".into();
    p.output.unit = "V".into();
    let text = summary(&p);
    assert!(
        text.contains(" V is ") && text.contains("reading ") && !text.contains("code "),
        "{text}"
    );
}

#[test]
fn the_summary_names_the_command_that_explains() {
    let mut p = common::accepted();
    let first = p.findings[0].id.clone();
    assert!(summary(&p).ends_with(&format!("\n`tumble explain {first}` tells more\n")));
    // Of an id that this version does not know it promises nothing.
    p.findings[0].id = "T9999".into();
    assert!(!summary(&p).contains("tumble explain"));
    p.findings.clear();
    assert!(!summary(&p).contains("tumble explain"));
}

#[test]
fn positions_that_do_not_belong_stand_in_a_table() {
    use tumble_io::passport::{LeftOutComparison, Outlier, PerParameter, ValueAndUncertainty};
    let mut p = common::accepted();
    assert!(!html(&p).contains("Positions that do not belong"));
    let three =
        |b, m, s| Some(PerParameter { bias: Some(b), misalignment: Some(m), scale_error: Some(s) });
    let outlier = |position: usize, left_out: bool| Outlier {
        run: "run-2".into(),
        position,
        angle_deg: -24.0,
        residual_lsb: Some(-3.21),
        studentized: Some(-6.1),
        p_value: Some(4e-5),
        named_by: (!left_out).then(|| "T0131".into()),
        left_out,
        effect: three(0.001, -2e-5, 1e-4),
        effect_over_u: three(1.25, -0.5, 0.0),
        uncertainty_ratio: three(0.8, 0.8, 0.8),
        pooled_effect: three(0.0002, -4e-6, 2e-5),
        pooled_effect_over_u: three(0.25, -0.15, 0.0),
    };
    p.outliers = vec![outlier(7, false), outlier(12, true)];
    let of = |value: f64| ValueAndUncertainty { value, expanded_uncertainty: 0.0012 };
    p.left_out_comparison = vec![LeftOutComparison {
        parameter: "bias".into(),
        mounting: None,
        with: of(-0.0071),
        without: of(-0.0063),
    }];
    let text = summary(&p);
    let line = text.lines().find(|l| l.contains("run-2:7")).unwrap();
    assert!(line.contains("-3.21 LSB") && line.contains("+1.25 / -0.50 / 0.00"), "{line}");
    assert!(line.ends_with("kept") && text.contains("left out"), "{text}");
    assert!(text.lines().all(|l| l.chars().count() <= 80) && !text.contains('−'), "{text}");
    let page = html(&p);
    for words in [
        "Positions that do not belong",
        "+1.25 / −0.50 / 0.00",
        "+0.25 / −0.15 / 0.00",
        "left out on request",
        "−0.0071 ± 0.0012",
        "−0.0063 ± 0.0012",
    ] {
        assert!(page.contains(words), "{words}");
    }
    p.verdict = "rejected".into();
    assert!(!summary(&p).contains("run-2:7") && !html(&p).contains("−0.0063"));
}
