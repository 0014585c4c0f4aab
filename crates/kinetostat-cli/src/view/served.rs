//! What a page with a server is answered: by the machine that is shown, or, before there is one, by the questions of `start`.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError, RwLock};

use kinetostat_diagnostic::ErrorCode;
use kinetostat_view::{Answers, OPEN, Refused};

use crate::compensate::{self, arguments::CompensateArgs};
use crate::files::outputs::Existing;
use crate::shown::answer::Nothing;
use crate::shown::session::{Session, answered};
use crate::start::interview::Interview;
use crate::ui::failure::{Answer, Code, Failing};
use crate::ui::given::Given;
use crate::view::asked::{AskedQuestion, GivenAnswer, StartAnswer, StartRequest};
use crate::view::dropped::{OpenRequest, session_of};
use crate::view::openapi::openapi;

/// The machine that is shown, and the questions before.
#[derive(Default)]
pub(super) struct Served {
    session: RwLock<Option<Arc<Session>>>,
    interview: Mutex<Option<Interview>>,
}

impl Served {
    pub(super) fn of(session: Session) -> Self {
        Self {
            session: RwLock::new(Some(Arc::new(session))),
            ..Self::default()
        }
    }

    /// No machine yet: the page asks for one, and for its program.
    pub(super) fn asking() -> Answer<Self> {
        let interview = Interview::new(Path::new(""), Existing::Refuse)?;
        Ok(Self {
            interview: Mutex::new(Some(interview)),
            ..Self::default()
        })
    }

    fn session(&self) -> Option<Arc<Session>> {
        let session = self.session.read();
        session.unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn show(&self, session: Session) {
        let mut shown = self.session.write().unwrap_or_else(PoisonError::into_inner);
        *shown = Some(Arc::new(session));
    }

    fn start(&self, request: &StartRequest) -> StartAnswer {
        let mut held = self
            .interview
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        let Some(interview) = held.as_mut() else {
            return StartAnswer::default();
        };
        if request.back {
            interview.back();
        }
        let (mut said, mut written, mut refused) = (Vec::new(), Vec::new(), None);
        if let Some(text) = &request.answer {
            match interview.take(text) {
                Ok(lines) => said = lines,
                Err(failure) => refused = Some(failure.plain),
            }
        }
        if request.write && interview.question().is_none() {
            match self.write(interview) {
                Ok(paths) => written = paths,
                Err(failure) => refused = Some(failure.plain),
            }
        }
        let question = interview.question().map(|question| AskedQuestion {
            words: question.words,
            help: question.help,
            usual: question.usual.map(str::to_owned),
            choices: interview.choices(),
        });
        let given = interview.given().map(|(words, answer)| GivenAnswer {
            words: words.to_owned(),
            answer: answer.to_owned(),
        });
        StartAnswer {
            question,
            given: given.collect(),
            said,
            refused,
            written,
        }
    }

    /// Writes the files, compensates as `start` on a terminal does, and shows the machine along its program.
    fn write(&self, interview: &Interview) -> Answer<Vec<String>> {
        let (job, paths) = interview.write()?;
        let ran = compensate::run(
            CompensateArgs::of_job(job.clone(), false),
            &Given::default(),
        );
        // A tolerance that is missed or rests on assumptions is a result, and the page shows its headline.
        if let Err(failure) = ran
            && !matches!(failure.code(), Code::ToleranceMissed | Code::Doubtful)
        {
            let words = format!(
                "{}\nThe files are written: change them, and compensate again (kinetostat compensate {}).",
                failure.plain,
                job.display()
            );
            return Err(ErrorCode::NoAnswer.failure(words));
        }
        self.show(Session::of_job(&job)?);
        let shown = |path: &PathBuf| path.display().to_string();
        Ok(paths.iter().map(shown).collect())
    }
}

impl Answers for Served {
    fn answer(&self, question: &str, request: &[u8]) -> Option<Result<String, Refused>> {
        match (question, self.session()) {
            ("openapi", _) => Some(answered(request, |Nothing {}| Ok(openapi()))),
            ("start", _) => Some(answered(request, |request| Ok(self.start(&request)))),
            (OPEN, _) => Some(answered(request, |open: OpenRequest| {
                self.show(session_of(&open.files)?);
                Ok(())
            })),
            (_, Some(session)) => session.answer(question, request),
            // The page asks for a machine first, and hears that there is none yet.
            ("machine", None) => Some(Ok("null".to_owned())),
            (_, None) => None,
        }
    }
}
