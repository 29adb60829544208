//! Help for every command, checked against the definition itself.
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.

use clap::Command;

use crate::cli::definition;

const WIDTH: usize = 80;

/// All commands but clap's own `help`, with their subcommands.
fn commands() -> Vec<Command> {
    fn collect(command: &Command, out: &mut Vec<Command>) {
        for c in command.get_subcommands().filter(|c| c.get_name() != "help") {
            out.push(c.clone());
            collect(c, out);
        }
    }
    let mut definition = definition();
    definition.build();
    let mut out = Vec::new();
    collect(&definition, &mut out);
    assert!(out.len() >= 6, "{}", out.len());
    out
}

fn after_help(command: &Command) -> String {
    command.get_after_help().map(ToString::to_string).unwrap_or_default()
}

/// Lines `tumble …` of a help, in any place of a pipe.
fn examples(help: &str) -> Vec<&str> {
    help.lines()
        .map(str::trim)
        .filter(|l| l.split('|').any(|p| p.trim().starts_with("tumble ")))
        .collect()
}

/// Words of the part of a line that begins with `tumble`, split as a shell does: quotes, comments, pipes, redirections.
fn words(line: &str) -> Vec<String> {
    let mut parts: Vec<Vec<String>> = vec![Vec::new()];
    let (mut word, mut started, mut quote, mut skip) = (String::new(), false, None, false);
    let mut chars = line.chars().peekable();
    loop {
        let c = chars.next();
        match (c, quote) {
            (Some(c), Some(q)) if c == q => quote = None,
            (Some(c), Some(_)) => word.push(c),
            (Some(q @ ('"' | '\'')), None) => {
                quote = Some(q);
                started = true;
            }
            (Some('#'), None) if !started => break,
            (None | Some(' ' | '|' | '>' | '<'), _) => {
                if started && !std::mem::take(&mut skip) {
                    parts.last_mut().unwrap().push(std::mem::take(&mut word));
                }
                word.clear();
                started = false;
                match c {
                    None => break,
                    Some('|') => parts.push(Vec::new()),
                    Some('>' | '<') => skip = true,
                    _ => {}
                }
            }
            (Some(c), None) => {
                word.push(c);
                started = true;
            }
        }
    }
    parts.into_iter().find(|p| p.first().is_some_and(|w| w == "tumble")).unwrap_or_default()
}

#[test]
fn words_are_split_as_a_shell_does() {
    assert_eq!(
        words("echo 100 | tumble compensate a.json > b.csv"),
        ["tumble", "compensate", "a.json"]
    );
    assert_eq!(words("tumble x 'a b' --c=\"d e\"  # f"), ["tumble", "x", "a b", "--c=d e"]);
    assert_eq!(words("tumble man | man -l -"), ["tumble", "man"]);
}

#[test]
fn the_definition_is_sound() {
    definition().debug_assert();
}

#[test]
fn every_command_says_what_it_does_with_examples_that_parse() {
    for command in commands() {
        let name = command.get_name();
        assert!(
            command.get_about().is_some_and(|a| a.to_string().len() > 10),
            "{name} has no about"
        );
        let help = after_help(&command);
        let (_, after) =
            help.split_once("Examples:\n").unwrap_or_else(|| panic!("{name} has no Examples:"));
        let lines = examples(after);
        assert!(lines.len() >= 2, "{name} has fewer than two examples");
        for line in lines {
            parses(line, Some(name));
        }
        for argument in command.get_arguments().filter(|a| !a.is_hide_set()) {
            assert!(argument.get_help().is_some(), "{name}: {} has no help", argument.get_id());
        }
    }
}

fn parses(line: &str, command: Option<&str>) {
    let matches =
        definition().try_get_matches_from(words(line)).unwrap_or_else(|e| panic!("{line}: {e}"));
    if let Some(name) = command {
        assert_eq!(matches.subcommand_name(), Some(name), "{line}");
    }
}

#[test]
fn no_line_of_help_is_wider_than_a_terminal() {
    let root = definition();
    for mut command in commands().into_iter().chain([root]) {
        let name = command.get_name().to_owned();
        let source = after_help(&command);
        let (short, long) =
            (command.render_help().to_string(), command.render_long_help().to_string());
        for text in [&source, &short, &long] {
            for line in text.lines() {
                assert!(line.chars().count() <= WIDTH, "{name}: {line}");
                assert!(!line.chars().any(char::is_control), "{name}: {line:?}");
            }
        }
        // Wrapping must not tear an example in two.
        for line in examples(&source) {
            assert!(long.contains(line), "{name}: {line}");
        }
    }
}

#[test]
fn first_steps_stand_in_the_main_help_and_parse() {
    let help = after_help(&definition());
    let steps = examples(&help);
    assert!(help.starts_with("First steps:\n") && help.contains("Exit codes: 0"), "{help}");
    assert!(steps.len() >= 3 && steps.iter().any(|s| s.starts_with("tumble certify")), "{help}");
    for step in steps {
        parses(step, None);
    }
}

#[test]
fn manual_pages_hold_every_command() {
    let pages = crate::commands::man::pages().unwrap();
    let (name, main) = &pages[0];
    assert_eq!(name, "tumble.1");
    assert!(main.contains(".TH tumble 1") && main.contains("First steps"), "{main}");
    for command in commands() {
        let name = format!("tumble\\-{}", command.get_name());
        assert!(main.contains(&name), "{name} is not in tumble.1");
        let file = format!("tumble-{}.1", command.get_name());
        let (_, page) = pages.iter().find(|(n, _)| *n == file).unwrap();
        assert!(page.contains("Examples:") && page.contains(".SH SYNOPSIS"), "{file}: {page}");
        assert!(page.contains(&format!(".TH {} 1", file.trim_end_matches(".1"))), "{file}: {page}");
    }
    assert_eq!(pages.len(), commands().len() + 1);
    assert!(!main.contains("tumble\\-help"), "a page that does not exist");
}

#[test]
fn only_days_of_the_calendar_are_days_of_issue() {
    let with =
        |day: &str| definition().try_get_matches_from(["tumble", "certify", "x", "--issued", day]);
    assert!(with("2026-11-23").is_ok());
    for wrong in ["today", "23.11.2026", "2026-02-30", "2026-11-23T10:00"] {
        assert!(with(wrong).unwrap_err().to_string().contains("YYYY-MM-DD"), "{wrong}");
    }
}
