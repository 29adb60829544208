//! `tumble man`
//!
//! A folder of manual pages belongs to many programs, so it is not swapped whole as output folders are: each page is
//! written by itself, and pages that differ are overwritten only on request.

use std::fs;
use std::io;
use std::path::Path;

use crate::cli::{ManArgs, definition};
use crate::exit::{Exit, complain, deliver};

pub(crate) fn run(args: &ManArgs) -> Exit {
    let pages = match pages() {
        Ok(pages) => pages,
        Err(e) => {
            complain(e);
            return Exit::Failure;
        }
    };
    match &args.out {
        Some(out) => write(&pages, out, args.replace),
        None => pages.first().map_or(Exit::Failure, |(_, text)| deliver(text)),
    }
}

/// `tumble.1` first, then a page a command, `tumble-certify.1`.
pub(crate) fn pages() -> io::Result<Vec<(String, String)>> {
    // `help` has no page: it prints the others' help.
    let mut definition = definition().disable_help_subcommand(true);
    definition.build();
    let page = |name: String, command: clap::Command| {
        let mut text = Vec::new();
        clap_mangen::Man::new(command.display_name(name.clone()))
            .title(name.clone())
            .render(&mut text)?;
        Ok((format!("{name}.1"), String::from_utf8_lossy(&text).into_owned()))
    };
    let mut pages = vec![page("tumble".into(), definition.clone())];
    for command in definition.get_subcommands() {
        pages.push(page(format!("tumble-{}", command.get_name()), command.clone()));
    }
    pages.into_iter().collect()
}

/// All or nothing where a page that differs is in the way.
fn write(pages: &[(String, String)], out: &Path, replace: bool) -> Exit {
    let fail = |path: &Path, e: &io::Error| {
        complain(format!("{}: {}", path.display(), tumble_io::advice(e)));
        Exit::Failure
    };
    if let Err(e) = fs::create_dir_all(out) {
        return fail(out, &e);
    }
    let mut new = Vec::new();
    for (name, text) in pages {
        let path = out.join(name);
        match fs::read(&path) {
            Ok(old) if old == text.as_bytes() => {}
            Ok(_) if !replace => {
                complain(format!(
                    "{} is there already and differs; choose another folder, or use --replace, which overwrites it",
                    path.display()
                ));
                return Exit::Usage;
            }
            Ok(_) => new.push((path, text)),
            Err(e) if e.kind() == io::ErrorKind::NotFound => new.push((path, text)),
            Err(e) => return fail(&path, &e),
        }
    }
    for (path, text) in &new {
        // Written aside and renamed: no reader meets half a page.
        let aside = path.with_extension(format!("{}.tumble-new", std::process::id()));
        if let Err(e) = fs::write(&aside, text).and_then(|()| fs::rename(&aside, path)) {
            let _ = fs::remove_file(&aside);
            return fail(path, &e);
        }
    }
    eprintln!("wrote {} of {} pages to {}", new.len(), pages.len(), out.display());
    Exit::Ok
}
