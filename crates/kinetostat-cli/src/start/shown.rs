//! What a page shows of an interview besides its question: answers to choose from, and those that were given.

use std::path::PathBuf;

use kinetostat_model::preset_names;

use crate::files::file_kind::FileKind;
use crate::job::format::WeightWord;
use crate::job::target_word::RobotWord;
use crate::start::ask::Ask;
use crate::start::interview::Interview;
use crate::start::reading::words_of;

impl Interview {
    /// Answers of the next question to choose from, where there are some.
    pub(crate) fn choices(&self) -> Vec<String> {
        self.answers.next().map(choices).unwrap_or_default()
    }

    /// The questions that were answered, with the answers.
    pub(crate) fn given(&self) -> impl Iterator<Item = (&str, &str)> {
        let all = self.before.iter();
        all.map(|given| (given.words.as_str(), given.text.as_str()))
    }
}

/// Files of the folder that are looked at for a choice.
const MOST_FILES: usize = 500;

fn choices(ask: Ask) -> Vec<String> {
    let words = |words: &[&str]| words.iter().map(|word| (*word).to_owned()).collect();
    match ask {
        Ask::Robot => {
            let mut all = files_here(&[FileKind::Model, FileKind::Urdf]);
            all.extend(preset_names().iter().map(|preset| preset.name.to_owned()));
            all
        }
        Ask::Program => files_here(&[FileKind::Program]),
        Ask::FlangeAxis => words(&["x", "y", "z"]),
        Ask::To => {
            let made = words_of::<RobotWord>().into_iter().map(|(word, _)| word);
            std::iter::once("g-code".to_owned()).chain(made).collect()
        }
        Ask::ToolAxis => words(&["x", "-x", "y", "-y", "z", "-z"]),
        Ask::Weight => words_of::<WeightWord>()
            .into_iter()
            .map(|(word, _)| word)
            .collect(),
        _ => Vec::new(),
    }
}

/// Names of the files of this folder that are of some kinds, in order.
fn files_here(kinds: &[FileKind]) -> Vec<String> {
    let entries = std::fs::read_dir(".").into_iter().flatten().flatten();
    let paths = entries.map(|entry| PathBuf::from(entry.file_name()));
    let is_asked =
        |path: &PathBuf| FileKind::of_file(path).is_some_and(|kind| kinds.contains(&kind));
    let mut names: Vec<String> = paths
        .take(MOST_FILES)
        .filter(is_asked)
        .map(|path| path.display().to_string())
        .collect();
    names.sort();
    names
}
