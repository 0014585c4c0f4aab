//! The machine of a run in its report: in three dimensions along the program, and on paper where the error is largest.

use kinetostat::Mechanism;
use kinetostat_machining::Run;
use kinetostat_model::Model;
use kinetostat_report::{Drawing, Language, MachineShown, Magnified, Moved, Placed};

use crate::job::machine::MachineSetup;
use crate::job::setting::Setting;
use crate::program::outputs::RunOutputs;
use crate::shown::answer::StateRequest;
use crate::shown::path::{AtPlace, ShownPath};
use crate::shown::session::Session;
use crate::ui::failure::Answer;

/// The machine for the reports of a run, if one is written that shows it; none of a run without places on cutting moves.
pub(crate) fn of_run(
    outputs: &RunOutputs,
    setting: &Setting,
    machine: &MachineSetup,
    model: &Model,
    run: &Run,
) -> Answer<Option<MachineShown>> {
    let is_asked = outputs.report.is_some() || outputs.pdf.is_some();
    if !is_asked || outputs.language != Language::English {
        return Ok(None);
    }
    let mechanism = &machine.mechanism;
    let path = ShownPath::of(setting, machine, run);
    let Some(&worst) = path.worst().first() else {
        return Ok(None);
    };
    let line = path.answer.places[worst].line;
    let Ok(picture) = picture(mechanism, &path.places[worst]) else {
        return Ok(None);
    };
    let job = setting.job_file.as_ref().map(|job| job.name.clone());
    let named = job.unwrap_or_else(|| {
        format!(
            "--model {} --program {}",
            model.name(),
            setting.program_name
        )
    });
    let mut shown = model.clone();
    shown.mechanism = mechanism.clone();
    let session = Session {
        named,
        path: None,
        model: shown,
        program: Some(path),
    };
    let start = StateRequest {
        place: Some(worst),
        ..StateRequest::default()
    };
    Ok(Some(MachineShown {
        page: match outputs.report {
            Some(_) => session.page(&start, false)?,
            None => String::new(),
        },
        picture,
        line,
    }))
}

/// The machine at a place of its program, and over it, larger than it is, as it bends there.
fn picture(mechanism: &Mechanism, place: &AtPlace) -> Answer<String> {
    let posture = place.posture(mechanism)?;
    let loaded = posture.deflected_by(&place.wrench)?;
    let mut drawing = Drawing::of(posture.mechanism(), Placed::at(&posture));
    drawing.moved = Some(Moved::deflected(&posture, &loaded.state, Magnified::Round));
    drawing.applied = Some(place.wrench);
    Ok(drawing.svg().0)
}
