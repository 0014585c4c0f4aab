//! Wrong input of every kind: exit code, a message that says what, where and what to do, nothing
//! written, no panic.

mod command_lines;
mod jobs;
mod lists;
mod models;
mod programs;

use std::path::Path;

use crate::common::{JOB, contents, run, shell, workplace};
use command_lines::command_lines;
use jobs::jobs;
use models::models;
use programs::programs;

/// A wrong question: files to write first, the command, its exit code, words of the message.
struct Case {
    name: &'static str,
    files: Vec<(&'static str, Vec<u8>)>,
    arguments: Vec<&'static str>,
    code: i32,
    words: &'static [&'static str],
}

fn case(
    name: &'static str,
    files: Vec<(&'static str, Vec<u8>)>,
    arguments: &[&'static str],
    code: i32,
    words: &'static [&'static str],
) -> Case {
    Case {
        name,
        files,
        arguments: arguments.to_vec(),
        code,
        words,
    }
}

#[track_caller]
fn changed(text: &str, from: &str, to: &str) -> Vec<u8> {
    assert!(text.contains(from), "'{from}' is not in the good file");
    text.replace(from, to).into_bytes()
}

#[track_caller]
fn check(case: &Case) {
    let here = workplace();
    for (name, bytes) in &case.files {
        std::fs::write(here.path().join(name), bytes).expect("a file");
    }
    let before = contents(here.path());
    let said = run(here.path(), &case.arguments);
    let shown = &said.err;
    let name = case.name;
    assert_eq!(said.code, case.code, "{name}: {said:?}");
    for word in case.words {
        assert!(shown.contains(word), "{name}: '{word}' is not in\n{shown}");
    }
    assert!(shown.starts_with("error"), "{name}: {shown}");
    for never in ["panicked", "RUST_BACKTRACE", "unwrap", "\u{1b}", "\u{7}"] {
        assert!(!shown.contains(never), "{name}: {shown}");
    }
    assert!(said.out.is_empty(), "{name}: {}", said.out);
    assert_eq!(
        contents(here.path()),
        before,
        "{name}: something was written"
    );
}

fn all(cases: Vec<Case>) -> usize {
    for case in &cases {
        check(case);
    }
    cases.len()
}

/// Read by `cargo xtask figures`; the tables themselves are assessed by the tests below.
#[test]
fn figure_wrong_inputs() {
    let count = models().len() + jobs().len() + programs().len() + command_lines().len();
    println!(
        "figure {{\"name\":\"wrong inputs whose message and exit code are tested\",\"measured\":{count},\"asked\":\"at least 40\",\"unit\":\"inputs\",\"holds\":{}}}",
        count >= 40
    );
    assert!(count >= 40);
}

#[test]
fn wrong_models() {
    assert!(all(models()) >= 20);
}

#[test]
fn wrong_jobs() {
    assert!(all(jobs()) >= 30);
}

#[test]
fn wrong_programs() {
    assert!(all(programs()) >= 18);
}

#[test]
fn wrong_command_lines() {
    assert!(all(command_lines()) >= 30);
}

/// The files of a directory apart from its clock: nothing new, nothing changed.
#[track_caller]
fn unchanged(directory: &Path, line: &str, words: &[&str]) {
    let before = contents(directory);
    let said = shell(directory, line);
    assert_eq!(said.code, 1, "{said:?}");
    for word in words {
        assert!(said.err.contains(word), "'{word}' is not in\n{}", said.err);
    }
    assert!(!said.err.contains("panicked"), "{}", said.err);
    assert_eq!(contents(directory), before);
}

#[test]
#[cfg(unix)]
fn a_disk_that_is_full() {
    let here = workplace();
    // The result on a full device.
    let said = shell(here.path(), "$K check orthoglide > /dev/full");
    assert_eq!(said.code, 1, "{said:?}");
    assert!(said.err.contains("disk is full"), "{}", said.err);
    let said = shell(here.path(), "$K deflect job.toml --json > /dev/full");
    assert_eq!(said.code, 1, "{said:?}");

    // A file that may not grow behaves like a full disk and needs no rights to set up. The
    // program fits, the report and the table do not: none of them is put in place.
    unchanged(
        here.path(),
        "trap '' XFSZ; ulimit -f 16; $K compensate job.toml --points p.csv --report r.html",
        &["cannot be written", "no output was changed"],
    );
    unchanged(
        here.path(),
        "trap '' XFSZ; ulimit -f 16; exec $K demo",
        &["cannot be written", "no output was changed"],
    );
    // The same where old files are to be replaced.
    std::fs::write(here.path().join("out.ngc"), "old").unwrap();
    unchanged(
        here.path(),
        "trap '' XFSZ; ulimit -f 16; $K compensate job.toml --points p.csv --force-overwrite",
        &["no output was changed"],
    );
}

#[test]
#[cfg(unix)]
fn a_real_full_disk_if_one_can_be_made() {
    let here = workplace();
    std::fs::create_dir(here.path().join("small")).unwrap();
    let line = "unshare -rm sh -c 'mount -t tmpfs -o size=64k none small && cp part.ngc small/ && \
                sed s/orthoglide/orthoglide/ job.toml > small/job.toml && cd small && \
                $K compensate job.toml --points p.csv --report r.html; echo code $?; ls -A'";
    let said = shell(here.path(), line);
    if !said.out.contains("code") {
        eprintln!("skipped: no file system can be mounted here: {}", said.err);
        return;
    }
    assert!(said.err.contains("disk is full"), "{said:?}");
    assert!(said.out.contains("code 1"), "{said:?}");
    let left: Vec<&str> = said.out.lines().skip(1).collect();
    assert_eq!(left, ["job.toml", "part.ngc"], "{said:?}");
}

#[test]
#[cfg(unix)]
fn a_directory_without_the_right_to_write() {
    use std::os::unix::fs::PermissionsExt;
    let here = workplace();
    let locked = here.path().join("locked");
    std::fs::create_dir(&locked).unwrap();
    std::fs::set_permissions(&locked, std::fs::Permissions::from_mode(0o555)).unwrap();
    let root = std::fs::write(locked.join("try"), "x").is_ok();
    if root {
        // Root may write anywhere but not into the process table.
        std::fs::remove_file(locked.join("try")).unwrap();
        let said = shell(here.path(), "$K compensate job.toml --out /proc/out.ngc");
        assert_eq!(said.code, 1, "{said:?}");
        assert!(said.err.contains("/proc/out.ngc"), "{}", said.err);
    } else {
        unchanged(
            here.path(),
            "$K compensate job.toml --out locked/out.ngc",
            &["may not write"],
        );
    }
    std::fs::set_permissions(&locked, std::fs::Permissions::from_mode(0o755)).unwrap();
}

#[test]
#[cfg(unix)]
fn links_are_not_followed() {
    use std::os::unix::fs::symlink;
    let here = workplace();
    let elsewhere = tempfile::tempdir().unwrap();
    let path = |name: &str| here.path().join(name);
    // An output that is a link, even with leave to overwrite.
    std::fs::write(elsewhere.path().join("victim"), "mine").unwrap();
    symlink(elsewhere.path().join("victim"), path("out.ngc")).unwrap();
    unchanged(here.path(), "$K compensate job.toml", &["symbolic link"]);
    unchanged(
        here.path(),
        "$K compensate job.toml --force-overwrite",
        &["symbolic link"],
    );
    std::fs::remove_file(path("out.ngc")).unwrap();
    // A link that points nowhere.
    symlink(elsewhere.path().join("new"), path("out.ngc")).unwrap();
    unchanged(here.path(), "$K compensate job.toml", &["symbolic link"]);
    assert!(!elsewhere.path().join("new").exists());
    std::fs::remove_file(path("out.ngc")).unwrap();
    // A job whose output directory leads out of its own.
    symlink(elsewhere.path(), path("sub")).unwrap();
    std::fs::write(path("leads.toml"), JOB.replace("out.ngc", "sub/out.ngc")).unwrap();
    unchanged(
        here.path(),
        "$K compensate leads.toml",
        &["outside the job's directory"],
    );
    // Another name of an input.
    std::fs::hard_link(path("part.ngc"), path("other.ngc")).unwrap();
    unchanged(
        here.path(),
        "$K compensate job.toml --out other.ngc --force-overwrite",
        &["same file as the input"],
    );
    assert_eq!(
        std::fs::read(elsewhere.path().join("victim")).unwrap(),
        b"mine"
    );
}

#[test]
fn colour_only_where_it_is_wanted() {
    let here = workplace();
    let plain = shell(here.path(), "$K check missing.toml");
    assert!(!plain.err.contains('\u{1b}'), "{}", plain.err);
    let forced = shell(here.path(), "CLICOLOR_FORCE=1 $K check missing.toml");
    assert!(forced.err.contains('\u{1b}'), "{}", forced.err);
    let refused = shell(here.path(), "NO_COLOR=1 $K check missing.toml");
    assert!(!refused.err.contains('\u{1b}'), "{}", refused.err);
}
