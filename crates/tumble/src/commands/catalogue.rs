//! `tumble catalogue`

use tumble_io::Catalogue;

use crate::cli::CatalogueArgs;
use crate::exit::{Exit, complain, deliver};

pub(crate) fn run(args: &CatalogueArgs) -> Exit {
    let catalogue = match &args.catalogue {
        None => Catalogue::builtin().clone(),
        Some(path) => match Catalogue::read(path) {
            Ok(user) => Catalogue::builtin().with(&user.catalogue),
            Err(e) => {
                complain(&e);
                return Exit::Usage;
            }
        },
    };
    let text = match &args.model {
        None if args.json => catalogue.to_json(),
        None => tumble_report::catalogue(&catalogue),
        Some(model) => match one(&catalogue, model, args) {
            Some(text) => text,
            None => {
                complain(unknown(&catalogue, model));
                return Exit::Usage;
            }
        },
    };
    deliver(&text)
}

/// One entry in full: a sensor, else a converter.
fn one(catalogue: &Catalogue, model: &str, args: &CatalogueArgs) -> Option<String> {
    if let Some(entry) = catalogue.find(model) {
        return Some(if args.json {
            entry.to_json()
        } else {
            tumble_report::catalogue_entry(entry)
        });
    }
    let converter = catalogue.find_converter(model)?;
    Some(if args.json {
        converter.to_json()
    } else {
        tumble_report::catalogue_converter(converter)
    })
}

fn unknown(catalogue: &Catalogue, model: &str) -> String {
    let shown: String = model.chars().filter(|c| !c.is_control()).take(80).collect();
    match catalogue.nearest(model)[..] {
        [] => format!(
            "the catalogue has no `{shown}`; `tumble catalogue` lists all, and docs/catalogue.md says how to add one"
        ),
        ref near => format!("the catalogue has no `{shown}`; nearest: {}", near.join(", ")),
    }
}
