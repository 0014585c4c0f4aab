//! Outputs of a long run: claimed before it begins, put in place when it is done.

use std::io::Read;
use std::path::PathBuf;

use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::RunInputs;
use sha2::{Digest, Sha256};

use crate::files::hash::hex;
use crate::files::origin;
use crate::files::outputs::{Existing, Outputs};
use crate::job::output_paths::OutputPaths;
use crate::long::checkpoint::Checkpoint;
use crate::long::partial::Partial;
use crate::program::aim::Aim;
use crate::program::outputs::RunOutputs;
use crate::program::points_parquet;
use crate::ui::failure::{Answer, Failing};
use crate::ui::progress::still_wanted;

/// Checkpoint of a run: beside the first output.
pub(crate) fn checkpoint(targets: &OutputPaths) -> Checkpoint {
    let targets = [
        &targets.program,
        &targets.points,
        &targets.report,
        &targets.json,
    ];
    let beside: Option<&PathBuf> = targets.into_iter().flatten().next();
    let beside = beside.cloned();
    Checkpoint::beside(&beside.unwrap_or_else(|| PathBuf::from("kinetostat")))
}

/// Claims the outputs of a long run; those that an earlier run of the same question put in place before it ended may be replaced.
pub(crate) fn claim(
    aim: Aim,
    targets: &OutputPaths,
    existing: Existing,
    inputs: &[PathBuf],
) -> Answer<RunOutputs> {
    let outputs = Outputs::new(existing, inputs.to_vec());
    let outputs = outputs.going_on_with(checkpoint(targets).placing());
    RunOutputs::claim_in(aim, targets, outputs)
}

/// Files of a run that is done, to be put in place.
pub(crate) struct LongFiles {
    pub(crate) program: Partial,
    pub(crate) points: Partial,
    pub(crate) kept: Checkpoint,
}

impl LongFiles {
    /// Writes them beside their targets.
    pub(crate) fn fill(
        &self,
        outputs: &mut RunOutputs,
        run_inputs: &RunInputs,
        targets: &OutputPaths,
    ) -> Answer<()> {
        self.or_kept(self.fill_all(outputs, run_inputs, targets))
    }

    /// An answer about putting outputs in place; where they cannot be, it is said that nothing is lost.
    pub(crate) fn or_kept<T>(&self, answer: Answer<T>) -> Answer<T> {
        answer.map_err(|failure| self.kept.with_advice(failure))
    }

    fn fill_all(
        &self,
        outputs: &mut RunOutputs,
        run_inputs: &RunInputs,
        targets: &OutputPaths,
    ) -> Answer<()> {
        if let Some(index) = outputs.program {
            let sha256 = put(&self.program, &mut outputs.files, index)?;
            // A paper states what was written.
            let made = targets.program.iter();
            let made = made.map(|path| origin::hashed("written program", path, sha256.clone()));
            outputs.made.extend(made);
        }
        if let Some(index) = outputs.points {
            match outputs.points_as_parquet {
                true => put_as_parquet(&self.points, run_inputs, &mut outputs.files, index)?,
                false => drop(put(&self.points, &mut outputs.files, index)?),
            }
        }
        Ok(())
    }

    /// Puts all files in place; an end between two of them is one that the same command goes on from.
    pub(crate) fn commit(&self, outputs: Outputs) -> Answer<Vec<PathBuf>> {
        self.or_kept(self.kept.note_placing(&outputs.entries()))?;
        self.or_kept(outputs.commit())
    }

    /// All is in place: nothing is kept.
    pub(crate) fn remove(self) {
        self.kept.remove();
    }
}

/// Puts a file that was kept into a claimed output; its hash.
fn put(from: &Partial, outputs: &mut Outputs, index: usize) -> Answer<String> {
    let mut reader = from.watched()?;
    let mut block = vec![0; 1 << 16];
    let mut hash = Sha256::new();
    loop {
        let count = reader.read(&mut block).map_err(|error| {
            ErrorCode::Checkpoint.failure(format!("what was kept cannot be read: {error}"))
        })?;
        if count == 0 {
            break;
        }
        hash.update(&block[..count]);
        outputs.append(index, &block[..count])?;
    }
    reader.refuse_if_changed()?;
    outputs.complete(index)?;
    Ok(hex(&hash.finalize()))
}

/// Puts the rows of points that were kept into a claimed output, as Parquet: its groups of rows do not grow with the program.
fn put_as_parquet(
    from: &Partial,
    run_inputs: &RunInputs,
    outputs: &mut Outputs,
    index: usize,
) -> Answer<()> {
    let mut reader = from.watched()?;
    points_parquet::from_csv(run_inputs, &mut reader, |bytes| {
        still_wanted()?;
        outputs.append(index, bytes)
    })?;
    reader.refuse_if_changed()?;
    outputs.complete(index)
}
