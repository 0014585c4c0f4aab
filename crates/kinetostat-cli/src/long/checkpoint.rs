//! Checkpoints of a run that takes long: enough to continue, never incomplete data.
//!
//! A folder beside the outputs holds a manifest (of what the run is), a state (what is done, with a check number), the state
//! before that, and the outputs as far as they are. A state is written beside the old one and renamed; outputs are synced before,
//! and cut back to its lengths when the run goes on. With the outputs in place the folder goes.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{FeatureResult, MergedRun, OfWhole};
use kinetostat_program::WriterState;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::files::hash::{FNV1A, fnv1a};
use crate::files::held_folder::{LOCK, hold};
use crate::files::journal::{Contents, Entry};
use crate::job::machine::MachineSetup;
use crate::long::difference::difference;
use crate::ui::failure::{Answer, Code, Failing, Failure};
use crate::ui::system_error::description;

/// Identity of a run, field by field with its value in words: another value is another run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Manifest(pub(crate) Vec<(String, String)>);

impl Manifest {
    /// The machine with tool, load and placement; or that there is none.
    pub(crate) fn of_machine(machine: Option<&MachineSetup>) -> Self {
        let Some(machine) = machine else {
            return Self(vec![("the model".to_owned(), "none".to_owned())]);
        };
        let inputs = &machine.run_inputs;
        let model = format!("{} {:016x}", inputs.model, machine.fingerprint);
        let loads = machine.tools.iter().map(|(number, _, load)| (number, load));
        // The first file is that of the model, whose comments count for nothing.
        let of_cut = inputs.files.iter().skip(1).map(|file| &file.sha256);
        let cut = (&inputs.cut, of_cut.collect::<Vec<_>>());
        let load = (&machine.load, loads.collect::<Vec<_>>(), cut);
        let fields = [
            ("the model", model),
            ("the load", format!("{load:#?}")),
            ("the weight", format!("{:?}", machine.weight)),
            ("the place of the part", format!("{:#?}", machine.placement)),
            ("the tool", inputs.tool.clone()),
        ];
        let fields = fields.map(|(name, value)| (name.to_owned(), value));
        Self(fields.to_vec())
    }

    /// The first field that another run has otherwise, with what of it differs.
    pub(crate) fn differs_in(&self, other: &Self) -> Option<String> {
        let both = self.0.iter().zip(&other.0);
        let found = both.into_iter().find(|(a, b)| a != b);
        let longer = || (self.0.len() != other.0.len()).then(|| "the settings".to_owned());
        found
            .map(|((name, kept), (_, now))| difference(name, kept, now))
            .or_else(longer)
    }
}

/// Progress of a run.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct State {
    /// Parts that are done.
    pub(crate) parts: usize,
    pub(crate) as_it_is: bool,
    /// Smallest stiffness that the first look found; not there as long as it goes on.
    pub(crate) stiffness_n_per_mm: Option<f64>,
    pub(crate) merged: MergedRun,
    pub(crate) features: Vec<FeatureResult>,
    pub(crate) writer: Option<WriterState>,
    pub(crate) program: Contents,
    pub(crate) points: Contents,
}

impl State {
    pub(crate) fn of_whole(&self) -> Option<OfWhole> {
        Some(OfWhole {
            stiffness_n_per_mm: self.stiffness_n_per_mm?,
            as_it_is: self.as_it_is,
            ..OfWhole::default()
        })
    }

    /// Stores the result of the first look; a look without a solved place is repeated, for a file has no infinite number.
    pub(crate) fn note(&mut self, whole: &OfWhole) {
        let found = Some(whole.stiffness_n_per_mm);
        self.stiffness_n_per_mm = found.filter(|stiffness| stiffness.is_finite());
    }
}

/// The folder of a run.
pub(crate) struct Checkpoint {
    folder: PathBuf,
    /// Locked as long as this run lives: two of them would write into one another's files.
    lock: Option<fs::File>,
}

/// Failure to save a checkpoint.
pub(crate) fn not_kept(path: &Path, error: &std::io::Error) -> Failure {
    let mut failure = ErrorCode::Output.failure(format!(
        "what is done so far cannot be kept in '{}': {}",
        path.display(),
        description(error)
    ));
    failure.is_not_kept = true;
    failure
}

const MANIFEST: &str = "manifest.json";
const STATE: &str = "state.json";
const STATE_BEFORE: &str = "state-before.json";

/// File that lists the outputs about to be put in place, with their contents.
const PLACING: &str = "placing.json";

impl Checkpoint {
    /// The folder beside an output.
    pub(crate) fn beside(output: &Path) -> Self {
        let mut name = output.file_name().unwrap_or_default().to_owned();
        name.push(".kinetostat-part");
        Self {
            folder: output.with_file_name(name),
            lock: None,
        }
    }

    fn refused(&self, error: &std::io::Error) -> Failure {
        not_kept(&self.folder, error)
    }

    /// Begins a run, or goes on with one that was interrupted: whether there may be one. `restart`: what was kept is thrown away.
    pub(crate) fn open(&mut self, manifest: &Manifest, restart: bool) -> Answer<bool> {
        self.take()?;
        if restart {
            self.clear();
        }
        let kept: Option<Manifest> = self.read(MANIFEST);
        match kept.as_ref().map(|kept| kept.differs_in(manifest)) {
            Some(None) => Ok(true),
            Some(Some(field)) if self.has_work() => Err(ErrorCode::Checkpoint.failure(format!(
                    "'{}' keeps a run that was interrupted, and what differs now is {field}; give the same question to go on with it, or --restart to begin anew (or delete the folder)",
                    self.folder.display()
                ),
            )),
            _ => {
                // Nothing, or not whole, or nothing done yet: begun anew.
                self.clear();
                self.write(MANIFEST, manifest)?;
                Ok(false)
            }
        }
    }

    /// True if there is work that would be lost.
    fn has_work(&self) -> bool {
        self.states().any(|state| state.parts > 0 || state.as_it_is)
    }

    /// Files are about to be put in place: a run that goes on may replace them.
    pub(crate) fn note_placing(&self, entries: &[Entry]) -> Answer<()> {
        self.write(PLACING, &entries)
    }

    /// Files that an interrupted run was putting in place.
    pub(crate) fn placing(&self) -> Vec<Entry> {
        self.read(PLACING).unwrap_or_default()
    }

    /// Makes the folder and locks it.
    fn take(&mut self) -> Answer<()> {
        // An earlier lock of this run would block it, too.
        self.lock = None;
        fs::create_dir_all(&self.folder).map_err(|error| self.refused(&error))?;
        let lock = hold(&self.folder).map_err(|error| self.refused(&error))?;
        let Some(lock) = lock else {
            return Err(ErrorCode::Output.failure(format!(
                    "another run writes the same output just now, and keeps what is done in '{}': wait until it has ended, or choose another output",
                    self.folder.display()
                ),
            ));
        };
        self.lock = Some(lock);
        Ok(())
    }

    /// Adds the advice for outputs that cannot be put in place.
    pub(crate) fn with_advice(&self, mut failure: Failure) -> Failure {
        failure.plain.push_str(&format!(
            "; all that was computed is kept in '{}', and the same command goes on from there",
            self.folder.display()
        ));
        failure.styled = None;
        failure
    }

    /// A failure of a run, with what becomes of what was done: where it was stopped, or that could not be kept.
    /// The folder stays where there is anything in it to go on from.
    pub(crate) fn left(self, mut failure: Failure) -> Failure {
        let stopped = failure.code() == Code::Stopped;
        let has_work = self.has_work();
        let done = match (has_work, failure.is_not_kept, stopped) {
            (true, true, _) => {
                "; what was kept before is not lost, and the same command goes on from there"
                    .to_owned()
            }
            (false, true, _) => {
                "; nothing had been kept yet: with room there, the same command begins anew"
                    .to_owned()
            }
            (true, false, true) => format!(
                "; what is done is kept in '{}', and the same command goes on from there",
                self.folder.display()
            ),
            _ => String::new(),
        };
        if !done.is_empty() {
            failure.plain.push_str(&done);
            failure.styled = None;
        }
        // One that another run holds is not ours to remove.
        if !has_work && self.lock.is_some() {
            self.remove();
        }
        failure
    }

    /// States that were kept, the last first.
    pub(crate) fn states(&self) -> impl Iterator<Item = State> + '_ {
        [STATE, STATE_BEFORE]
            .into_iter()
            .filter_map(|name| self.read(name))
    }

    /// Keeps a state; the one before stays.
    pub(crate) fn keep(&self, state: &State) -> Answer<()> {
        let own = self.folder.join(STATE);
        if own.exists() {
            let kept = fs::rename(&own, self.folder.join(STATE_BEFORE));
            kept.map_err(|error| self.refused(&error))?;
        }
        self.write(STATE, state)
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// The run is over: nothing is left.
    pub(crate) fn remove(mut self) {
        self.clear();
        self.lock = None;
        let _ = fs::remove_file(self.folder.join(LOCK));
        let _ = fs::remove_dir(&self.folder);
    }

    fn clear(&self) {
        for name in [
            MANIFEST,
            STATE,
            STATE_BEFORE,
            PLACING,
            "new",
            "program",
            "points",
        ] {
            let _ = fs::remove_file(self.folder.join(name));
        }
    }

    /// A value behind its check number.
    fn write(&self, name: &str, value: &impl Serialize) -> Answer<()> {
        let text = serde_json::to_string(value).map_err(|error| {
            ErrorCode::Internal.failure(format!("the state of the run cannot be kept: {error}"))
        })?;
        let new = self.folder.join("new");
        let written = || -> std::io::Result<()> {
            let mut file = fs::File::create(&new)?;
            writeln!(file, "{:016x}", fnv1a(FNV1A, text.as_bytes()))?;
            file.write_all(text.as_bytes())?;
            file.sync_all()?;
            fs::rename(&new, self.folder.join(name))?;
            if let Ok(folder) = fs::File::open(&self.folder) {
                let _ = folder.sync_all();
            }
            Ok(())
        };
        written().map_err(|error| self.refused(&error))
    }

    /// A value, if it is there and whole.
    fn read<T: DeserializeOwned>(&self, name: &str) -> Option<T> {
        let text = fs::read_to_string(self.folder.join(name)).ok()?;
        let (check, text) = text.split_once('\n')?;
        let whole = check == format!("{:016x}", fnv1a(FNV1A, text.as_bytes()));
        whole.then(|| serde_json::from_str(text).ok()).flatten()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn manifest(model: &str) -> Manifest {
        let fields = [("the version", "1"), ("the model", model)];
        Manifest(fields.map(|(a, b)| (a.to_owned(), b.to_owned())).to_vec())
    }

    #[test]
    fn another_question_is_named_and_a_damaged_state_is_that_before() {
        let here = tempfile::tempdir().unwrap();
        let mut kept = Checkpoint::beside(&here.path().join("out.ngc"));
        assert!(!kept.open(&manifest("a"), false).unwrap());
        let state = |parts| State {
            parts,
            ..State::default()
        };
        kept.keep(&state(1)).unwrap();
        kept.keep(&state(2)).unwrap();
        assert!(kept.open(&manifest("a"), false).unwrap());
        let mut other = Checkpoint::beside(&here.path().join("out.ngc"));
        let said = other.open(&manifest("a"), false).unwrap_err().plain;
        assert!(said.contains("another run writes"), "{said}");
        let parts: Vec<usize> = kept.states().map(|state| state.parts).collect();
        assert_eq!(parts, [2, 1]);
        let said = kept.open(&manifest("b"), false).unwrap_err().plain;
        assert!(said.contains("what differs now is the model"), "{said}");
        let bytes = fs::read(kept.path(STATE)).unwrap();
        fs::write(kept.path(STATE), &bytes[..bytes.len() / 2]).unwrap();
        assert_eq!(kept.states().next().unwrap().parts, 1);
        assert!(!kept.open(&manifest("b"), true).unwrap());
        // A run without finished parts loses nothing.
        assert!(!kept.open(&manifest("a"), false).unwrap());
        kept.remove();
        assert_eq!(fs::read_dir(here.path()).unwrap().count(), 0);
    }
}
