//! Every shell example of the book does what the book says.
//!
//! A chapter is one directory and one story: a fence after `<!-- file: NAME -->` is written there as
//! a file, and every `console` fence is run, in order. Lines after `$ ` are commands for `sh`; what
//! follows is their whole output, where `...` stands for any lines and `[..]` for anything within a
//! line. A command must succeed unless the line `? CODE` follows it. Pictures that the commands draw are
//! those that the chapter shows.

#![cfg(unix)]

use std::path::{Path, PathBuf};
use std::process::Command;

/// A piece of a chapter that does something.
enum ChapterStep {
    File { name: String, text: String },
    Shell(Call),
}

/// A command and what it must say.
struct Call {
    line: usize,
    command: String,
    code: i32,
    output: Vec<String>,
}

fn pages() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../book/src")
}

/// Steps of a chapter in their order.
fn steps(text: &str) -> Vec<ChapterStep> {
    let (mut found, mut name) = (Vec::new(), None);
    let mut lines = text.lines().enumerate();
    while let Some((_, line)) = lines.next() {
        if let Some(own) = line.strip_prefix("<!-- file: ") {
            name = Some(own.trim_end_matches(" -->").to_owned());
        }
        let Some(language) = line.strip_prefix("```") else {
            continue;
        };
        let body: Vec<(usize, &str)> = lines.by_ref().take_while(|l| l.1 != "```").collect();
        if let Some(name) = name.take() {
            let text = body.iter().map(|l| format!("{}\n", l.1)).collect();
            found.push(ChapterStep::File { name, text });
        } else if language == "console" {
            found.extend(calls(&body).into_iter().map(ChapterStep::Shell));
        }
    }
    found
}

fn calls(body: &[(usize, &str)]) -> Vec<Call> {
    let mut calls: Vec<Call> = Vec::new();
    for (index, line) in body {
        if let Some(command) = line.strip_prefix("$ ") {
            calls.push(Call {
                line: index + 1,
                command: command.to_owned(),
                code: 0,
                output: Vec::new(),
            });
        } else if let Some(call) = calls.last_mut() {
            match line.strip_prefix("? ").and_then(|c| c.parse().ok()) {
                Some(code) if call.output.is_empty() => call.code = code,
                _ => call.output.push((*line).to_owned()),
            }
        }
    }
    calls
}

/// Whether lines are as expected; `...` is any number of them.
fn fits(expected: &[String], found: &[&str]) -> bool {
    match expected.split_first() {
        None => found.is_empty(),
        Some((first, rest)) if first == "..." => {
            (0..=found.len()).any(|skipped| fits(rest, &found[skipped..]))
        }
        Some((first, rest)) => found
            .split_first()
            .is_some_and(|(own, others)| line_fits(first, own) && fits(rest, others)),
    }
}

/// Whether one line is as expected; `[..]` is anything.
fn line_fits(expected: &str, found: &str) -> bool {
    let Some((before, after)) = expected.split_once("[..]") else {
        return expected.trim_end() == found.trim_end();
    };
    found.strip_prefix(before).is_some_and(|rest| {
        (0..=rest.len())
            .filter(|&at| rest.is_char_boundary(at))
            .any(|at| line_fits(after, &rest[at..]))
    })
}

/// Runs a chapter; returns the number of commands and what went otherwise than it says.
fn play(page: &Path) -> (usize, Vec<String>) {
    let text = std::fs::read_to_string(page).expect("a chapter");
    let here = tempfile::tempdir().expect("a directory");
    let own = Path::new(env!("CARGO_BIN_EXE_kinetostat"));
    let path = format!(
        "{}:{}",
        own.parent().expect("a directory").display(),
        std::env::var("PATH").unwrap_or_default()
    );
    let (mut count, mut wrong) = (0, Vec::new());
    for step in steps(&text) {
        let call = match step {
            ChapterStep::File { name, text } => {
                std::fs::write(here.path().join(name), text).expect("a file");
                continue;
            }
            ChapterStep::Shell(call) => call,
        };
        count += 1;
        let answer = Command::new("sh")
            .args(["-c", &format!("{{ {}\n}} 2>&1", call.command)])
            .env("PATH", &path)
            .env_remove("COLUMNS")
            .current_dir(here.path())
            .output()
            .expect("sh");
        let said = String::from_utf8_lossy(&answer.stdout);
        let mut lines: Vec<&str> = said.lines().collect();
        while lines.last().is_some_and(|l| l.trim().is_empty()) {
            lines.pop();
        }
        if answer.status.code() != Some(call.code) || !fits(&call.output, &lines) {
            wrong.push(format!(
                "{}:{}: $ {}\nended with {:?} and said:\n{said}",
                page.display(),
                call.line,
                call.command,
                answer.status.code()
            ));
        }
    }
    wrong.extend(other_pictures(page, &text, here.path()));
    (count, wrong)
}

/// Pictures of a chapter that its commands draw otherwise. With `BOOK_UPDATE=1` they are taken over.
fn other_pictures(page: &Path, text: &str, here: &Path) -> Vec<String> {
    let mut other = Vec::new();
    for rest in text.split("pictures/").skip(1) {
        let name = rest.split(')').next().unwrap_or_default();
        let (drawn, shown) = (here.join(name), pages().join("pictures").join(name));
        if !drawn.exists() || std::fs::read(&drawn).ok() == std::fs::read(&shown).ok() {
            continue;
        }
        if std::env::var_os("BOOK_UPDATE").is_some() {
            std::fs::copy(&drawn, &shown).expect("a picture");
        } else {
            other.push(format!(
                "{}: {name} is drawn otherwise now: take it over with BOOK_UPDATE=1",
                page.display()
            ));
        }
    }
    other
}

/// All chapters, folders included.
fn chapters(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).expect("the book") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            found.extend(chapters(&path));
        } else if path.extension().is_some_and(|e| e == "md") {
            found.push(path);
        }
    }
    found.sort();
    found
}

#[test]
fn every_shell_example_does_what_the_book_says() {
    let (mut count, mut wrong) = (0, Vec::new());
    for page in chapters(&pages()) {
        let (own, failed) = play(&page);
        count += own;
        wrong.extend(failed);
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
    assert!(count >= 10, "only {count} commands found");
}

#[test]
fn elisions_stand_for_what_they_say() {
    let lines = |text: &str| text.lines().map(str::to_owned).collect::<Vec<_>>();
    assert!(fits(&lines("a\n...\nd"), &["a", "b", "c", "d"]));
    assert!(fits(&lines("a [..] c"), &["a b, b c"]));
    assert!(!fits(&lines("a\n..."), &["b", "a"]));
    assert!(!fits(&lines("a"), &["a", "b"]));
    assert!(!fits(&lines("[..]x"), &["y"]));
}
