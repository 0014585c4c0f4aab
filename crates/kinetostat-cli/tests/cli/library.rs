//! The book's page of the robot library: an entry and a drawing for every preset that is no
//! teaching example, made from the model files. `BOOK_UPDATE=1 cargo test --workspace --test cli
//! library::` writes them anew.

use std::path::{Path, PathBuf};

use crate::common::{run, workplace};
use kinetostat_model::{Model, Preset, PresetKind, preset_names};

const FROM: &str = "<!-- machines, from the model files -->\n";
const TO: &str = "<!-- end of machines -->\n";

fn book() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../book/src")
}

fn picture(name: &str) -> PathBuf {
    book().join(format!("pictures/machine-{name}.svg"))
}

/// `1 limb`, `3 limbs`.
fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// As a sentence: capital letter first, one full stop last.
fn sentence(text: &str) -> String {
    let mut letters = text.trim().trim_end_matches('.').chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string());
    let text = format!("{}{}.", first.unwrap_or_default(), letters.as_str());
    // Square brackets are links in a book, stars and lines are emphasis.
    let mut out = String::new();
    for c in text.chars() {
        if matches!(c, '[' | ']' | '*' | '_' | '<' | '|') {
            out.push('\\');
        }
        out.push(c);
    }
    out
}

fn entry(preset: &Preset) -> String {
    let name = preset.name;
    let model = Model::preset(name).expect("a preset");
    let m = &model.mechanism;
    let home = m.platforms()[m.tool()].home;
    let posture = m.posture(&home).expect("home");
    let stiff = posture.stiffness().expect("a stiffness").rank();
    let mass = m.moving_mass();
    let words = &model.document.mechanism;
    let mut out = format!("### {name}\n\n![Drawing of {name}](../pictures/machine-{name}.svg)\n\n");
    out.push_str(&sentence(
        words.description.as_deref().unwrap_or(preset.description),
    ));
    out.push_str(&format!(
        " {}, {}, {} of the tool; stiff in {stiff} of 6 directions at home",
        counted(m.limbs().len(), "limb"),
        counted(m.actuator_count(), "actuator"),
        counted(posture.mobility().ncols(), "motion"),
    ));
    out.push_str(&match mass {
        mass if mass > 0.0 => format!("; {mass:.0} kg move.\n"),
        _ => "; no weights.\n".to_owned(),
    });
    for (head, text) in [("From", &words.source), ("Assumed", &words.assumption)] {
        if let Some(text) = text {
            out.push_str(&format!("\n*{head}:* {}\n", sentence(text)));
        }
    }
    out.push('\n');
    out
}

fn entries() -> String {
    let mut out = String::new();
    for kind in PresetKind::ALL {
        let own: Vec<&Preset> = preset_names().iter().filter(|p| p.kind == kind).collect();
        if kind == PresetKind::Teaching || own.is_empty() {
            continue;
        }
        out.push_str(&format!("\n## {}\n\n", kind.heading()));
        own.iter().for_each(|p| out.push_str(&entry(p)));
    }
    out
}

#[test]
fn every_machine_of_the_library_has_its_entry_and_drawing_in_the_book() {
    let here = workplace();
    let update = std::env::var_os("BOOK_UPDATE").is_some();
    let page = book().join("machines/library.md");
    let text = std::fs::read_to_string(&page).expect("the page");
    let (before, rest) = text.split_once(FROM).expect("the first mark");
    let (found, after) = rest.split_once(TO).expect("the last mark");
    let expected = entries();
    let mut other: Vec<String> = Vec::new();
    if update {
        let text = format!("{before}{FROM}{expected}{TO}{after}");
        std::fs::write(&page, text).expect("the page");
    } else if found != expected {
        other.push("the entries of machines/library.md".to_owned());
    }
    for preset in preset_names() {
        if preset.kind == PresetKind::Teaching {
            continue;
        }
        let name = preset.name;
        let drawn = run(here.path(), &["model", "draw", name]).answered().out;
        let shown = picture(name);
        if update {
            std::fs::write(&shown, &drawn).expect("a picture");
        } else if std::fs::read_to_string(&shown).ok().as_deref() != Some(&drawn) {
            other.push(format!("pictures/machine-{name}.svg"));
        }
    }
    assert!(
        other.is_empty(),
        "{other:#?} would be otherwise now: BOOK_UPDATE=1 takes it over"
    );
    // Drawings of machines that are gone.
    let names: Vec<PathBuf> = preset_names().iter().map(|p| picture(p.name)).collect();
    for file in std::fs::read_dir(book().join("pictures")).expect("pictures") {
        let path = file.expect("a file").path();
        let own = path
            .file_name()
            .is_some_and(|n| n.to_string_lossy().starts_with("machine-"));
        assert!(
            !own || names.contains(&path),
            "no preset: {}",
            path.display()
        );
    }
}
