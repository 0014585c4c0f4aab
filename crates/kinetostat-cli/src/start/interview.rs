//! Questions and answers in their order, however they are shown.

use std::path::{Path, PathBuf};

use kinetostat_diagnostic::ErrorCode;

use crate::check::job::as_far_as_known;
use crate::files::outputs::{Existing, Outputs};
use crate::start::answers::Answers;
use crate::start::draft;
use crate::start::question::Question;
use crate::start::reading::wrong;
use crate::ui::failure::{Answer, Failing};

/// What was asked and answered so far. An answer that cannot be taken leaves everything as it is.
pub(crate) struct Interview {
    pub(super) answers: Answers,
    pub(super) before: Vec<Given>,
    existing: Existing,
}

/// An answer that was taken, and all answers before it.
#[cfg_attr(
    not(feature = "view"),
    expect(dead_code, reason = "the page shows what was answered")
)]
pub(super) struct Given {
    pub(super) words: String,
    pub(super) text: String,
    before: Answers,
}

impl Interview {
    /// Nothing is answered yet. The files go into `folder`, where nobody hears after all questions that one is there already.
    pub(crate) fn new(folder: &Path, existing: Existing) -> Answer<Self> {
        let answers = Answers {
            folder: folder.to_owned(),
            ..Answers::default()
        };
        claimed(&answers, existing).map_err(|failure| {
            let job = folder.join(draft::JOB);
            ErrorCode::Output.failure(format!(
                "{}. To see the job that is there: kinetostat view {}",
                failure.plain,
                job.display()
            ))
        })?;
        Ok(Self {
            answers,
            before: Vec::new(),
            existing,
        })
    }

    /// The next question; none when all is known.
    pub(crate) fn question(&self) -> Option<Question> {
        let ask = self.answers.next()?;
        Some(Question::of(ask, &self.answers))
    }

    /// Takes an answer to the next question, empty for what is usual; what was understood, line by line.
    pub(crate) fn take(&mut self, text: &str) -> Answer<Vec<String>> {
        let Some(ask) = self.answers.next() else {
            return Ok(Vec::new());
        };
        let question = Question::of(ask, &self.answers);
        let text = match (text.trim(), question.usual) {
            ("", Some(usual)) => usual,
            ("", None) => {
                return Err(wrong(&format!(
                    "this has no usual answer. {}",
                    question.help
                )));
            }
            (text, _) => text,
        };
        let mut next = self.answers.clone();
        let said = next.take(ask, text)?;
        claimed(&next, self.existing)?;
        checked(&next, self.existing)?;
        self.before.push(Given {
            words: question.words,
            text: text.to_owned(),
            before: std::mem::replace(&mut self.answers, next),
        });
        Ok(said
            .iter()
            .flat_map(|said| said.lines())
            .map(str::to_owned)
            .collect())
    }

    /// Forgets the last answer.
    pub(crate) fn back(&mut self) {
        if let Some(given) = self.before.pop() {
            self.answers = given.before;
        }
    }

    /// Writes the files; gives that of the job, and all.
    pub(crate) fn write(&self) -> Answer<(PathBuf, Vec<PathBuf>)> {
        let mut outputs = claimed(&self.answers, self.existing)?;
        for (index, (_, _, text)) in draft::files(&self.answers).into_iter().enumerate() {
            outputs.fill(index, text.as_bytes())?;
        }
        Ok((self.answers.folder.join(draft::JOB), outputs.commit()?))
    }
}

/// The files that the answers make so far.
fn claimed(answers: &Answers, existing: Existing) -> Answer<Outputs> {
    let mut outputs = Outputs::new(existing, Vec::new());
    for (what, path, _) in draft::files(answers) {
        outputs.claim(what, &path)?;
    }
    Ok(outputs)
}

/// Looks at the job as far as it is known: its values, its outputs, and whether the machine reaches the program. What else may be
/// wrong the first run says, with the files there to be changed.
fn checked(answers: &Answers, existing: Existing) -> Answer<()> {
    if !answers.can_be_checked() {
        return Ok(());
    }
    let job = answers.folder.join(draft::JOB);
    let found = as_far_as_known(&draft::in_memory(answers), &job)?;
    if let (Existing::Refuse, Some(path)) = (existing, found.existing.first()) {
        return Err(ErrorCode::Output.failure(format!(
            "the result would be written to '{path}', which exists already: start with another --out, or with --force-overwrite"
        )));
    }
    match found.unreached.as_slice() {
        [] => Ok(()),
        [first, rest @ ..] => Err(wrong(&match rest.len() {
            0 => first.clone(),
            n => format!("{first} (and {n} more of its ends)"),
        })),
    }
}
