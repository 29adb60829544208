//! `docs/passport.schema.json` and `docs/passport.md` against passports that the library makes.
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use boon::{Compiler, SchemaIndex, Schemas};
use serde_json::{Value, json};
use tumble_core::estimate::{EstimateOptions, Method};
use tumble_core::simulate::{Preset, Truth};
use tumble_io::passport::Passport;
use tumble_io::{CertifyOptions, Existing, SimulationOptions, certify, write_simulation};

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The published schema, as text and compiled.
struct Published {
    json: Value,
    schemas: Schemas,
    index: SchemaIndex,
}

impl Published {
    fn read() -> Self {
        let text = fs::read_to_string(repository().join("docs/passport.schema.json")).unwrap();
        let json: Value = serde_json::from_str(&text).unwrap();
        let id = json["$id"].as_str().unwrap().to_owned();
        let (mut compiler, mut schemas) = (Compiler::new(), Schemas::new());
        compiler.add_resource(&id, json.clone()).unwrap();
        let index = compiler.compile(&id, &mut schemas).unwrap_or_else(|e| panic!("{e:#}"));
        Self { json, schemas, index }
    }

    /// What is wrong with a passport.
    fn refusal(&self, passport: &Value) -> Option<String> {
        self.schemas.validate(passport, self.index).err().map(|e| format!("{e:#}"))
    }

    /// A schema with everything that it applies to the same instance: `$ref`, `allOf`, `anyOf`, `oneOf`.
    fn applied<'a>(&'a self, schema: &'a Value, into: &mut Vec<&'a Value>) {
        into.push(schema);
        if let Some(pointer) = schema["$ref"].as_str().and_then(|r| r.strip_prefix('#')) {
            let target = self.json.pointer(pointer);
            self.applied(target.unwrap_or_else(|| panic!("no {pointer}")), into);
        }
        for key in ["allOf", "anyOf", "oneOf"] {
            for part in schema[key].as_array().into_iter().flatten() {
                self.applied(part, into);
            }
        }
    }

    /// Keys of a value that the schema does not describe, with their places.
    fn undescribed(
        &self,
        schemas: &[&Value],
        value: &Value,
        place: &str,
        into: &mut BTreeSet<String>,
    ) {
        let mut applied = Vec::new();
        schemas.iter().for_each(|s| self.applied(s, &mut applied));
        match value {
            Value::Object(fields) => {
                for (key, field) in fields {
                    let place = format!("{place}.{key}");
                    let of_field: Vec<&Value> =
                        applied.iter().filter_map(|s| s["properties"].get(key)).collect();
                    if !of_field.iter().any(|s| s["description"].is_string()) {
                        into.insert(place.clone());
                    }
                    self.undescribed(&of_field, field, &place, into);
                }
            }
            Value::Array(items) => {
                let of_items: Vec<&Value> = applied.iter().filter_map(|s| s.get("items")).collect();
                let place = format!("{place}[]");
                items.iter().for_each(|item| self.undescribed(&of_items, item, &place, into));
            }
            _ => {}
        }
    }

    /// Names of all properties, wherever they stand.
    fn property_names(&self) -> BTreeSet<&str> {
        fn collect<'a>(schema: &'a Value, into: &mut BTreeSet<&'a str>) {
            if let Some(properties) = schema["properties"].as_object() {
                into.extend(properties.keys().map(String::as_str));
            }
            match schema {
                Value::Object(o) => o.values().for_each(|v| collect(v, into)),
                Value::Array(a) => a.iter().for_each(|v| collect(v, into)),
                _ => {}
            }
        }
        let mut names = BTreeSet::new();
        collect(&self.json, &mut names);
        names
    }
}

// --- passports ---

/// The paper's third sensor with short dwells.
fn truth() -> Truth {
    Truth { dwell_s: 2.0, ..Preset::Paper3.truth() }
}

/// Writes a simulated experiment, edits its experiment.toml, certifies it.
fn simulated(truth: &Truth, scale_pair: bool, edit: impl Fn(String) -> String) -> Value {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path().join("experiment");
    let options = SimulationOptions {
        model: "ADXL203".into(),
        serial: "3".into(),
        gzip: false,
        averaged: false,
        stated_angle_uncertainty_arcmin: truth.setting_scatter.arcmin(),
        scale_pair,
        existing: Existing::Keep,
    };
    write_simulation(truth, &options, &folder, &|| false).unwrap();
    let file = folder.join("experiment.toml");
    fs::write(&file, edit(fs::read_to_string(&file).unwrap())).unwrap();
    certified(&folder, &CertifyOptions::default())
}

/// An experiment of averaged dwells at given angles and codes.
fn averaged(positions: &[(f64, f64)], runs: usize) -> Value {
    let dir = tempfile::tempdir().unwrap();
    let mut toml = String::from(
        "[sensor]\n[output]\nquantizer = \"round\"\nnominal_scale = 0.00769\n[bench]\ngravity = 9.81\n",
    );
    let rows: String =
        positions.iter().map(|(angle, code)| format!("{angle},{code},100,0.5\n")).collect();
    for run in 1..=runs {
        toml.push_str(&format!("[[run]]\nfile = \"run-{run}.csv\"\n"));
        let text = format!("angle_deg,mean_code,samples,std_code\n{rows}");
        fs::write(dir.path().join(format!("run-{run}.csv")), text).unwrap();
    }
    fs::write(dir.path().join("experiment.toml"), toml).unwrap();
    certified(dir.path(), &CertifyOptions::default())
}

fn certified(folder: &Path, options: &CertifyOptions) -> Value {
    let passport = certify(folder, options).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    serde_json::from_str(&passport.to_json().unwrap()).unwrap()
}

fn accepted() -> Value {
    let passport = simulated(&truth(), false, |toml| toml);
    assert_eq!(passport["verdict"], "accepted", "{:#}", passport["missing"]);
    passport
}

fn replaced(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "no `{from}` in\n{text}");
    text.replace(from, to)
}

/// Limits of everything, with everything that may be said about them.
const SPEC: &str = "[spec]\nspecification = \"data sheet\"\nbias_limits_mg = 25\n\
    misalignment_limits_arcmin = [-60, inf]\nscale_error_limits_percent = 4\n\
    scale_factor_limits = [0.0074, 0.0080]\ndecision_rule = \"non-binary\"\nguard_band = 0.83\n\
    prior_bias_m_s2 = [0.0, 0.08]\n";

/// Passports of all verdicts, with names.
fn passports() -> Vec<(String, Value)> {
    let short = Truth { runs: 2, ..truth() };
    let warm = Truth { temperature_degc: Some((20.0, 25.0)), ..truth() };
    let code = |deg: f64| (9.81 * deg.to_radians().sin() - 0.0063) / 0.00769;
    let exact: Vec<(f64, f64)> =
        (-6..=6).map(|i| f64::from(10 * i)).map(|a| (a, code(a))).collect();
    let mut all = vec![
        ("accepted".to_owned(), accepted()),
        (
            "accepted, with everything that is optional".to_owned(),
            simulated(&warm, true, |toml| {
                let toml = replaced(
                    &toml,
                    "angle_uncertainty_arcmin",
                    "angle_range_deg = [-65, 65]\nangle_uncertainty_arcmin",
                );
                let toml = replaced(&toml, "rate_hz", "min_code = -2048\nmax_code = 2047\nrate_hz");
                let toml = format!("{toml}\n{SPEC}");
                let remarks =
                    "mounting = \"A\"\ndate = 2026-03-01\noperator = \"N. N.\"\nnote = \"warm\"";
                let toml = replaced(&toml, "mounting = \"A\"", remarks);
                replaced(&toml, "format = 1", "format = 1\nid = \"7/26\"\nissued = 2026-03-02")
            }),
        ),
        (
            "several mountings".to_owned(),
            simulated(&truth(), false, |toml| {
                let second = "file = \"run-2.csv\"\nmounting = ";
                replaced(&toml, &format!("{second}\"A\""), &format!("{second}\"B\""))
            }),
        ),
        (
            "positions left out".to_owned(),
            simulated(&truth(), false, |toml| {
                let second = "file = \"run-2.csv\"\n";
                replaced(&toml, second, &format!("{second}leave_out = [7, 12]\n"))
            }),
        ),
        (
            "rejected".to_owned(),
            simulated(&short, false, |toml| replaced(&toml, "[bench]", "[bench]\nangle_sign = -1")),
        ),
        (
            "up and down only".to_owned(),
            simulated(&short, true, |toml| {
                let (head, _) = toml.split_once("[[run]]").unwrap();
                head.to_owned()
            }),
        ),
        (
            "nominal scale from up and down".to_owned(),
            simulated(&short, true, |toml| replaced(&toml, "nominal_scale", "# nominal_scale")),
        ),
        (
            "limits and no result".to_owned(),
            simulated(&short, false, |toml| {
                let toml = replaced(&toml, "[bench]", "[bench]\nangle_sign = -1");
                format!("{toml}\n{SPEC}")
            }),
        ),
        (
            "a tolerance below the uncertainty".to_owned(),
            simulated(&truth(), false, |toml| {
                format!("{toml}\n[spec]\nbias_limits_m_s2 = 1e-6\nscale_error_limits_ppm = 1\n")
            }),
        ),
        ("one angle".to_owned(), averaged(&[(20.0, code(20.0)); 10], 1)),
        ("two angles".to_owned(), averaged(&[(-30.0, code(-30.0)), (30.0, code(30.0))], 1)),
        (
            "three angles".to_owned(),
            averaged(&[(-30.0, code(-30.0)), (0.0, code(0.0)), (30.0, code(30.0))], 1),
        ),
        ("no noise at all".to_owned(), averaged(&exact, 1)),
        ("copies".to_owned(), averaged(&exact, 2)),
    ];
    let folder = repository().join("tests/data/reference");
    let mut sets: Vec<PathBuf> = fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.join("experiment.toml").is_file())
        .collect();
    sets.sort();
    assert!(sets.len() >= 10, "only {} reference sets in {}", sets.len(), folder.display());
    for set in sets {
        for method in [Method::Likelihood, Method::Exact, Method::Paper] {
            let estimate = EstimateOptions { method, ..EstimateOptions::default() };
            let options = CertifyOptions { estimate, ..CertifyOptions::default() };
            let name = format!("{} {method:?}", set.file_name().unwrap().to_string_lossy());
            all.push((name, certified(&set, &options)));
        }
    }
    all
}

// --- tests ---

#[test]
fn passports_of_every_verdict_follow_the_schema() {
    let published = Published::read();
    let mut verdicts = BTreeSet::new();
    let mut failed = Vec::new();
    for (name, passport) in passports() {
        verdicts.insert(passport["verdict"].as_str().unwrap().to_owned());
        failed.extend(published.refusal(&passport).map(|refusal| format!("{name}: {refusal}")));
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
    let all = ["accepted", "indeterminate", "rejected"].map(str::to_owned);
    assert_eq!(verdicts, BTreeSet::from(all), "verdicts that were tried");
}

#[test]
fn the_schema_describes_every_key_that_is_written() {
    let published = Published::read();
    let mut undescribed = BTreeSet::new();
    for (_, passport) in passports() {
        published.undescribed(&[&published.json], &passport, "", &mut undescribed);
    }
    assert!(undescribed.is_empty(), "keys without a description in the schema: {undescribed:#?}");

    // The walk must be able to fail: on top, inside of an item of a list, and behind a nullable reference.
    let mut passport = accepted();
    passport["unknown_a"] = json!(1);
    passport["runs"][0]["estimates"]["bias"]["unknown_b"] = json!(1);
    passport["error_level_lsb"]["unknown_c"] = json!(1);
    published.undescribed(&[&published.json], &passport, "", &mut undescribed);
    let expected = [".error_level_lsb.unknown_c", ".runs[].estimates.bias.unknown_b", ".unknown_a"]
        .map(str::to_owned);
    assert_eq!(undescribed, BTreeSet::from(expected));
}

#[test]
fn every_property_of_the_schema_is_explained_on_its_page() {
    let published = Published::read();
    let page = fs::read_to_string(repository().join("docs/passport.md")).unwrap();
    let quoted: BTreeSet<&str> = page.split('`').skip(1).step_by(2).collect();
    let names = published.property_names();
    assert!(names.len() > 80, "only {} properties in the schema", names.len());
    let explained = |name: &str| quoted.iter().any(|q| q.rsplit('.').next() == Some(name));
    let missing: Vec<&str> = names.into_iter().filter(|name| !explained(name)).collect();
    assert!(missing.is_empty(), "docs/passport.md says nothing about {missing:?}");
}

#[test]
fn unknown_fields_are_allowed() {
    let published = Published::read();
    let mut passport = accepted();
    passport["later"] = json!({"a": 1});
    passport["result"]["bias"]["later"] = json!(2);
    assert_eq!(published.refusal(&passport), None);
    Passport::from_json(&passport.to_string()).unwrap();
}

/// A value with one place (a JSON pointer) set, or removed for `None`.
fn changed(value: &Value, place: &str, to: Option<Value>) -> Value {
    let mut out = value.clone();
    let (parent, key) = place.rsplit_once('/').unwrap();
    match (out.pointer_mut(parent).unwrap(), to) {
        (Value::Object(fields), Some(to)) => drop(fields.insert(key.to_owned(), to)),
        (Value::Object(fields), None) => drop(fields.remove(key)),
        (other, _) => panic!("{parent} is no object: {other}"),
    }
    out
}

/// The passport of the same data, as if it had been rejected.
fn as_rejected(accepted: &Value) -> Value {
    let mut p = changed(&changed(accepted, "/result", None), "/compensation", None);
    p["verdict"] = json!("rejected");
    p["reasons"] = json!(["T0101 the run is measured backwards in sign: ..."]);
    p
}

#[test]
fn legal_passports_are_not_refused() {
    let published = Published::read();
    let good = accepted();
    assert_eq!(published.refusal(&good), None);
    let mut legal = as_rejected(&good);
    assert_eq!(published.refusal(&legal), None, "rejected without result");
    legal["verdict"] = json!("indeterminate");
    (legal["missing"], legal["reasons"]) = (legal["reasons"].clone(), json!([]));
    assert_eq!(published.refusal(&legal), None, "indeterminate without result");
    (legal["result"], legal["compensation"]) =
        (good["result"].clone(), good["compensation"].clone());
    assert_eq!(published.refusal(&legal), None, "indeterminate with result");
}

#[test]
fn broken_passports_are_refused() {
    let published = Published::read();
    let good = accepted();
    let rejected = as_rejected(&good);
    let result = || Some(good["result"].clone());
    let compensation = || Some(good["compensation"].clone());
    let with_result = changed(&rejected, "/result", result());
    let one = json!({"name": "A", "misalignment": good["result"]["misalignment"]});
    let sentence = json!(["T0101 the run is measured backwards in sign: ..."]);
    let cases = [
        // The conditions that hang on the verdict.
        ("accepted without result", &good, "/result", None),
        ("accepted without compensation", &good, "/compensation", None),
        ("accepted without both", &changed(&good, "/result", None), "/compensation", None),
        ("accepted with reasons", &good, "/reasons", Some(sentence.clone())),
        ("accepted with missing", &good, "/missing", Some(sentence.clone())),
        ("rejected with result", &rejected, "/result", result()),
        ("rejected with compensation", &rejected, "/compensation", compensation()),
        ("rejected with both", &with_result, "/compensation", compensation()),
        ("rejected without a reason", &rejected, "/reasons", Some(json!([]))),
        ("rejected without reasons", &rejected, "/reasons", None),
        ("indeterminate with nothing missing", &good, "/verdict", Some(json!("indeterminate"))),
        // Words.
        ("wrong verdict", &good, "/verdict", Some(json!("ok"))),
        ("verdict with a capital", &good, "/verdict", Some(json!("Accepted"))),
        ("no verdict", &good, "/verdict", None),
        ("wrong conformity", &good, "/conformity/status", Some(json!("passed"))),
        ("wrong severity", &good, "/findings/0/severity", Some(json!("error"))),
        ("wrong id of a finding", &good, "/findings/0/id", Some(json!("T12"))),
        ("wrong method", &good, "/method", Some(json!("magic"))),
        ("wrong quantizer", &good, "/output/quantizer", Some(json!("ceil"))),
        ("wrong offset", &good, "/compensation/quantizer_offset", Some(json!("full"))),
        ("wrong unit", &good, "/result/bias/unit", Some(json!("g"))),
        ("wrong unit of a run", &good, "/runs/0/estimates/misalignment/unit", Some(json!("deg"))),
        ("another schema", &good, "/schema", Some(json!("tumble-passport/2"))),
        (
            "another order",
            &good,
            "/parameters",
            Some(json!(["scale_error", "misalignment", "bias"])),
        ),
        ("short digest", &good, "/inputs/0/sha256", Some(json!("abc"))),
        ("digest in capitals", &good, "/inputs/0/sha256", Some(json!("A".repeat(64)))),
        // Numbers.
        ("negative uncertainty", &good, "/result/bias/standard_uncertainty", Some(json!(-1e-9))),
        (
            "negative u of a run",
            &good,
            "/runs/0/estimates/bias/standard_uncertainty",
            Some(json!(-1e-9)),
        ),
        (
            "negative u of gravity",
            &good,
            "/bench/gravity_m_s2/standard_uncertainty",
            Some(json!(-1)),
        ),
        ("negative contribution", &good, "/budget/0/contribution", Some(json!(-1))),
        ("uncertainty as a text", &good, "/result/bias/standard_uncertainty", Some(json!("0.1"))),
        ("estimate without value", &good, "/result/bias/value", None),
        ("correlation beyond one", &good, "/runs/0/correlations/0/value", Some(json!(1.5))),
        ("level of 95", &good, "/options/level", Some(json!(95))),
        // Shapes.
        ("interval of three numbers", &good, "/result/bias/interval", Some(json!([0, 1, 2]))),
        ("interval of one number", &good, "/result/bias/interval", Some(json!([0]))),
        ("interval with a null", &good, "/result/bias/interval", Some(json!([0, null]))),
        (
            "three numbers in a run",
            &good,
            "/runs/0/estimates/bias/interval",
            Some(json!([0, 1, 2])),
        ),
        ("two rows", &good, "/result/covariance", Some(json!([[1, 0, 0], [0, 1, 0]]))),
        ("a short row", &good, "/runs/0/covariance", Some(json!([[1, 0, 0], [0, 1, 0], [0, 0]]))),
        (
            "3 × 3 for 2 × 2",
            &good,
            "/compensation/covariance",
            Some(json!([[1, 0, 0], [0, 1, 0], [0, 0, 1]])),
        ),
        ("no misalignment", &good, "/result/misalignment", None),
        ("misalignment and mountings", &good, "/result/mountings", Some(json!([one, one]))),
    ];
    let mut survivors = Vec::new();
    for (name, base, place, to) in cases {
        let broken = changed(base, place, to);
        assert_ne!(&broken, base, "{name} changes nothing");
        if published.refusal(&broken).is_none() {
            survivors.push(name);
        }
    }
    assert!(survivors.is_empty(), "the schema lets pass: {survivors:?}");
}

/// Places of all fields of a value as JSON pointers, one for each kind: only the first item of a list.
fn places(value: &Value, place: &str, into: &mut Vec<String>) {
    match value {
        Value::Object(fields) => {
            for (key, field) in fields {
                let place = format!("{place}/{key}");
                places(field, &place, into);
                into.push(place);
            }
        }
        Value::Array(items) => {
            if let Some(first) = items.first() {
                places(first, &format!("{place}/0"), into);
            }
        }
        _ => {}
    }
}

/// The schema is written by hand beside the types that read: what it lets pass must be readable.
#[test]
fn what_the_schema_lets_pass_can_be_read() {
    let published = Published::read();
    let (mut passed, mut refused) = (0, 0);
    let mut wrong = BTreeSet::new();
    for (name, mut good) in passports().into_iter().take(3) {
        // One of each is enough, and the others take time.
        good["runs"].as_array_mut().unwrap().truncate(1);
        for list in ["sequential", "residuals"] {
            good["runs"][0][list].as_array_mut().unwrap().truncate(1);
        }
        assert_eq!(published.refusal(&good), None, "{name}");
        let mut all = Vec::new();
        places(&good, "", &mut all);
        assert!(all.len() > 100, "only {} fields in {name}", all.len());
        for place in &all {
            let others = [json!(null), json!("x"), json!(0.5), json!([]), json!({})].map(Some);
            for other in [None].into_iter().chain(others) {
                let changed = changed(&good, place, other.clone());
                if published.refusal(&changed).is_some() {
                    refused += 1;
                } else {
                    passed += 1;
                    if let Err(e) = Passport::from_json(&changed.to_string()) {
                        wrong.insert(format!("{place} = {other:?}: {e}"));
                    }
                }
            }
        }
    }
    assert!(wrong.is_empty(), "the schema lets pass what cannot be read: {wrong:#?}");
    // Both happen: optional fields can be left out, and wrong types are noticed.
    assert!(passed > 100 && refused > 1000, "{passed} passed, {refused} refused");
}
