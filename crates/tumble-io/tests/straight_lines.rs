//! Weighted straight lines and lines with errors in both variables, against figures that others printed (ISO/TS 28037,
//! Bevington, Mathioulakis and Belessiotis), through the product's least squares.
//!
//! The figures stay outside this repository, in `../shared/data`; without them this is skipped aloud.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // A test that cannot unwrap has failed; figures are for people.

use std::path::Path;

use serde_json::Value;
use tumble_core::linalg::Triangular;

fn examples() -> Option<Value> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../../shared/data/gum_calibration/examples.json");
    if !file.exists() {
        println!("SKIPPED: {} is not here", file.display());
        return None;
    }
    Some(serde_json::from_str(&std::fs::read_to_string(file).unwrap()).unwrap())
}

fn numbers(set: &Value, name: &str) -> Option<Vec<f64>> {
    let list = set["data"][name].as_array()?;
    Some(list.iter().map(|v| v.as_f64().unwrap()).collect())
}

struct Line {
    a: f64,
    b: f64,
    ua: f64,
    ub: f64,
    cov: f64,
    chi2: f64,
}

/// Errors in y alone; without `uy` the scatter of the residuals tells them.
fn line(x: &[f64], y: &[f64], uy: Option<&[f64]>) -> Line {
    let mut t = Triangular::new(2);
    for (i, (x, y)) in x.iter().zip(y).enumerate() {
        let u = uy.map_or(1.0, |u| u[i]);
        t.push(&[1.0 / u, x / u], y / u);
    }
    let s2 = if uy.is_some() { 1.0 } else { t.residual_sum_of_squares() / (x.len() - 2) as f64 };
    read(&t, s2)
}

fn read(t: &Triangular, s2: f64) -> Line {
    let (b, c) = (t.solve().unwrap(), t.unit_covariance().unwrap().scaled(s2));
    let n = b.len();
    Line {
        a: b[n - 2],
        b: b[n - 1],
        ua: c[(n - 2, n - 2)].sqrt(),
        ub: c[(n - 1, n - 1)].sqrt(),
        cov: c[(n - 2, n - 1)],
        chi2: t.residual_sum_of_squares(),
    }
}

/// Errors in both: the true abscissas are unknowns too; Gauss and Newton about the last solution (clause 7).
fn line_with_errors_in_both(x: &[f64], ux: &[f64], y: &[f64], uy: &[f64]) -> Line {
    let n = x.len();
    let mut at: Vec<f64> = x.to_vec();
    let mut out = line(x, y, Some(uy));
    for _ in 0..50 {
        let mut t = Triangular::new(n + 2);
        for i in 0..n {
            let mut row = vec![0.0; n + 2];
            row[i] = 1.0 / ux[i];
            t.push(&row, (x[i] - at[i]) / ux[i]);
            // y ≈ a + b (X + δ) = a + b X + b δ; the unknowns a and b are whole, δ is a shift.
            row[i] = out.b / uy[i];
            row[n] = 1.0 / uy[i];
            row[n + 1] = at[i] / uy[i];
            t.push(&row, y[i] / uy[i]);
        }
        let b = t.solve().unwrap();
        (0..n).for_each(|i| at[i] += b[i]);
        out = read(&t, 1.0);
    }
    out
}

/// Half of the last digit that was printed, and what the source allows beyond it.
fn close(name: &str, what: &str, ours: f64, printed: f64, half_digit: f64) {
    let error = (ours - printed).abs();
    assert!(error <= half_digit, "{name} {what}: {ours} against {printed}");
}

#[test]
fn iso_28037_to_the_printed_digits() {
    let Some(all) = examples() else { return };
    for (name, half) in
        [("ISO28037_clause6_wls_equal", 5e-7), ("ISO28037_clause6_wls_unequal", 5e-4)]
    {
        let set = &all[name];
        let (x, y, uy) = ("x", "y", "uy");
        let [x, y, uy] = [x, y, uy].map(|k| numbers(set, k).unwrap());
        let l = line(&x, &y, Some(&uy));
        let printed = |k: &str| set["expected"][k].as_f64().unwrap();
        close(name, "a", l.a, printed("a"), half);
        close(name, "b", l.b, printed("b"), half);
        close(name, "u(a)", l.ua, printed("ua"), 5e-7);
        close(name, "u(b)", l.ub, printed("ub"), 5e-7);
        close(name, "cov", l.cov, printed("cov"), 5e-8);
        close(name, "χ²", l.chi2, printed("chi2"), 5e-4);
    }
    let set = &all["ISO28037_clause7_wtls"];
    let [x, ux, y, uy] = ["x", "ux", "y", "uy"].map(|k| numbers(set, k).unwrap());
    let l = line_with_errors_in_both(&x, &ux, &y, &uy);
    let printed = |k: &str| set["expected"][k].as_f64().unwrap();
    for (what, ours, k) in [
        ("a", l.a, "a"),
        ("b", l.b, "b"),
        ("u(a)", l.ua, "ua"),
        ("u(b)", l.ub, "ub"),
        ("cov", l.cov, "cov"),
        ("χ²", l.chi2, "chi2"),
    ] {
        // χ² is printed with three decimals, the rest with four.
        close("clause 7", what, ours, printed(k), if k == "chi2" { 5e-4 } else { 1e-4 });
    }
}

#[test]
fn lines_of_textbooks() {
    let Some(all) = examples() else { return };
    let set = &all["Bevington_6_1_ols"];
    let [x, y] = ["x", "y"].map(|k| numbers(set, k).unwrap());
    let l = line(&x, &y, None);
    let printed = |k: &str| set["expected"][k].as_f64().unwrap();
    close("Bevington 6.1", "a", l.a, printed("a"), 5e-7);
    close("Bevington 6.1", "b", l.b, printed("b"), 5e-6);
    close("Bevington 6.1", "u(a)", l.ua, printed("ua"), 5e-9);
    close("Bevington 6.1", "u(b)", l.ub, printed("ub"), 5e-10);
    close("Bevington 6.1", "cov", l.cov, printed("cov"), 5e-11);

    let set = &all["Mathioulakis_Belessiotis_2000_temperature_sensor_wtls"];
    let [x, ux, y, uy] = ["x", "ux", "y", "uy"].map(|k| numbers(set, k).unwrap());
    let l = line_with_errors_in_both(&x, &ux, &y, &uy);
    let printed = |k: &str| set["expected"][k].as_f64().unwrap();
    // Printed 0.0991 and 0.97839, half a digit beyond what the printed data give; numpy agrees with us to nine digits.
    close("Mathioulakis", "a", l.a, printed("a"), 1e-4);
    close("Mathioulakis", "b", l.b, printed("b"), 1e-5);
    close("Mathioulakis", "a (numpy)", l.a, 0.099_034_242_190_280_54, 1e-9);
    close("Mathioulakis", "b (numpy)", l.b, 0.978_396_412_504_408_5, 1e-9);
    close("Mathioulakis", "u(a)", l.ua, printed("ua"), 5e-5);
    close("Mathioulakis", "u(b)", l.ub, printed("ub"), 5e-6);
}
