//! The machine of `assemble`: as built, and as drawn.

use kinetostat::Mechanism;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::straight_tool;
use kinetostat_model::Model;
use kinetostat_model::schema::{Axis, AxisName, Deviation, Placement};

use crate::assemble::arguments::AssembleArgs;
use crate::files::input_files::InputFiles;
use crate::place::query::{PlaceQuery, place_query_of};
use crate::ui::failure::{Answer, Failing, Failure};

/// The query, and the machine without its deviations.
pub(crate) struct AssemblyQuery {
    pub(crate) query: PlaceQuery,
    pub(crate) perfect: Mechanism,
}

pub(crate) fn assembly_query(args: &AssembleArgs) -> Answer<AssemblyQuery> {
    let files = InputFiles::default();
    let (mut model, path) = files.model(&args.model, std::path::Path::new(""))?;
    for text in &args.deviation {
        let refuse = |reason: &str| refused(text, reason);
        for deviation in written(text, &model)? {
            model = model.deviating(deviation).map_err(|error| {
                let first = error.problems().first();
                let (message, help) = first.map_or_else(
                    || (error.to_string(), String::new()),
                    |p| (p.message.clone(), p.help.clone()),
                );
                refuse(&format!("{message}; {help}"))
            })?;
        }
    }
    let tool = straight_tool(1e-3 * args.tool_length_mm.unwrap_or(0.0));
    let perfect = model.without_deviations()?.mechanism.with_tool(&tool);
    let query = place_query_of(
        &model,
        path,
        &args.model,
        &args.place,
        args.tool_length_mm,
        args.force.as_deref(),
        args.moment.as_deref(),
    )?;
    Ok(AssemblyQuery { query, perfect })
}

fn refused(deviation: &str, reason: &str) -> Failure {
    ErrorCode::Value.failure(format!("--deviation '{deviation}': {reason}"))
}

/// `LIMB:AT:WHAT` as deviations of one limb, or of all.
fn written(text: &str, model: &Model) -> Answer<Vec<Deviation>> {
    const FORM: &str = "write LIMB:AT:WHAT, as in \"leg x:line:1deg about x\", \"leg y:bar:0.2mm longer\" or \"*:foot:1mm along z\"";
    let no_form = || refused(text, FORM);
    let (place, what) = text.rsplit_once(':').ok_or_else(no_form)?;
    let (limb, at) = place.split_once(':').ok_or_else(no_form)?;
    let mut made = what_is_wrong(what.trim()).ok_or_else(|| {
        let reason = format!("'{}' is not understood; {FORM}", what.trim());
        refused(text, &reason)
    })?;
    made.at = at.trim().to_owned();
    let limbs: Vec<String> = match limb.trim() {
        "*" => model.document.limb.iter().map(|l| l.name.clone()).collect(),
        name => vec![name.to_owned()],
    };
    let list = limbs.into_iter().map(|limb| Deviation {
        limb,
        ..made.clone()
    });
    Ok(list.collect())
}

/// `1deg about x`, `0.2mm longer`, `1mm along 0,1,1`.
fn what_is_wrong(text: &str) -> Option<Deviation> {
    let split = text.find(|c: char| c.is_ascii_alphabetic() && !matches!(c, 'e' | 'E'))?;
    let value: f64 = text[..split].trim().parse().ok()?;
    let words: Vec<&str> = text[split..].split_whitespace().collect();
    let mut made = Deviation::default();
    match words[..] {
        ["mm", "longer"] => made.longer_by_mm = Some(value),
        ["mm", "shorter"] => made.longer_by_mm = Some(-value),
        ["deg", "about", axis] => {
            made.tilted_by_deg = Some(value);
            made.about = Some(axis_of(axis)?);
        }
        ["mm", "along", axis] => {
            let v = match axis_of(axis)? {
                Axis::Vector(v) => nalgebra::Vector3::from(v).try_normalize(1e-12)?,
                named => nalgebra::Vector3::from(letter(&named)?),
            };
            made.moved_by = Some(Placement {
                translation_mm: Some((v * value).into()),
                ..Placement::default()
            });
        }
        _ => return None,
    }
    Some(made)
}

fn axis_of(text: &str) -> Option<Axis> {
    Some(match text {
        "x" => Axis::Named(AxisName::X),
        "y" => Axis::Named(AxisName::Y),
        "z" => Axis::Named(AxisName::Z),
        "-x" => Axis::Named(AxisName::MinusX),
        "-y" => Axis::Named(AxisName::MinusY),
        "-z" => Axis::Named(AxisName::MinusZ),
        numbers => {
            let list: Vec<f64> = numbers
                .split(',')
                .map(|x| x.parse().ok())
                .collect::<Option<_>>()?;
            Axis::Vector(list.try_into().ok()?)
        }
    })
}

fn letter(axis: &Axis) -> Option<[f64; 3]> {
    let Axis::Named(name) = axis else { return None };
    Some(match name {
        AxisName::X => [1.0, 0.0, 0.0],
        AxisName::Y => [0.0, 1.0, 0.0],
        AxisName::Z => [0.0, 0.0, 1.0],
        AxisName::MinusX => [-1.0, 0.0, 0.0],
        AxisName::MinusY => [0.0, -1.0, 0.0],
        AxisName::MinusZ => [0.0, 0.0, -1.0],
    })
}
