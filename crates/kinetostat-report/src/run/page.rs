//! The page: the template filled with figures, drawings and tables.

use kinetostat_machining::FeatureResult;
use minijinja::{Environment, Value, context};

use crate::chart::panel::Sheet;
use crate::chart::section::Section;
use crate::number::{self, MISSING, typeset};
use crate::run::{Shown, along, chatter, cutting, facts, joints, meaning, plan};
use crate::svg::picture_address;
use crate::{text, turns};

/// The name ends in `.html`, which switches automatic escaping on.
const PAGE: &str = "report.html";

const STYLE: &str = concat!(
    include_str!("../template/palette.css"),
    include_str!("../template/plot.css"),
    include_str!("../template/area.css"),
    include_str!("../template/page.css")
);

/// Maximum number of warnings shown; more are in the result file.
const MOST_WARNINGS: usize = 100;

/// Fills the page.
pub(crate) fn render(result: &Shown<'_>) -> Result<String, minijinja::Error> {
    let mut environment = Environment::new();
    environment.add_template(PAGE, include_str!("../template/report.html"))?;
    let run_inputs = &result.run_inputs;
    let assessment = meaning::assessment(result);
    let warnings: Vec<String> = result
        .warnings
        .iter()
        .map(|warning| text::clean(&warning.to_string()))
        .collect();
    let actuators = run_inputs.actuators.len();
    environment.get_template(PAGE)?.render(context! {
        style => Value::from_safe_string(match result.turns {
            Some(_) => STYLE.to_owned() + &Section::filled_style(),
            None => STYLE.to_owned(),
        }),
        program => name_or(&run_inputs.program, "Unnamed program"),
        model => name_or(&run_inputs.model, "unnamed machine"),
        version => text::shorten(&result.kinetostat_version, 40),
        compensated => run_inputs.compensated,
        assessment => context! {
            class => meaning::class(assessment.level),
            word => meaning::word(assessment.level),
            sentence => assessment.sentence(result),
        },
        heading => facts::heading(result),
        cards => facts::cards(result),
        errors => figure(result, along::errors),
        views => figure(result, plan::views),
        magnification => plan::magnification(result).map(number::setting),
        machine => result.machine.map(|machine| context! {
            page => &machine.page,
            picture => Value::from_safe_string(picture_address(&machine.picture)),
            line => machine.line,
        }),
        cutting => cutting::section(result, figure(result, cutting::figure)),
        chatter => chatter::section(result),
        actuators => figure(result, along::actuators),
        actuators_left_out => actuators.saturating_sub(along::MOST_ACTUATORS),
        joints => figure(result, joints::figure),
        joint_facts => joints::facts(result),
        turns => result.turns.map(|(choice, _)| Value::from_safe_string(turns::element(choice))),
        turns_sentence => result.turns.map(|(_, words)| text::clean(words)),
        stiffness => figure(result, along::stiffness),
        can_buckle => result.summary.largest_share_to_buckling.is_some(),
        features => table(result),
        worst => facts::worst(result),
        uncorrected => facts::uncorrected(result),
        warnings_left_out => warnings.len().saturating_sub(MOST_WARNINGS),
        warning_count => warnings.len(),
        warnings => warnings.into_iter().take(MOST_WARNINGS).collect::<Vec<_>>(),
        inputs_of_run => facts::inputs_of_run(result),
        caption => facts::caption(result),
        missing => MISSING,
    })
}

/// A name short enough for the title.
fn name_or(name: &str, otherwise: &str) -> String {
    let name = if name.trim().is_empty() {
        otherwise
    } else {
        name
    };
    text::shorten(name, 80)
}

/// A drawing for wide windows and paper, and one for telephones; the style sheet shows one of them.
fn figure(result: &Shown<'_>, draw: fn(&Shown<'_>, Sheet) -> String) -> Value {
    let wide = draw(result, Sheet::Wide);
    if wide.is_empty() {
        return Value::from(());
    }
    Value::from_safe_string(wide + "\n" + &draw(result, Sheet::Narrow))
}

/// Maximum number of features shown; more are in the result file.
const MOST: usize = 200;

/// Rows of features; nothing where the job names none.
fn table(result: &Shown<'_>) -> Value {
    if result.features.is_empty() {
        return Value::from(());
    }
    let rows: Vec<Value> = result.features.iter().take(MOST).map(row).collect();
    context! { left_out => result.features.len() - rows.len(), rows }
}

fn row(feature: &FeatureResult) -> Value {
    let [name, lines, before, after, allowed, verdict] = feature.cells();
    let length = |cell: String| match cell.is_empty() {
        true => MISSING.to_owned(),
        false => typeset(&cell),
    };
    let [before, after, allowed] = [before, after, allowed].map(length);
    let name = text::clean(&name);
    context! { name, lines, before, after, allowed, verdict, missed => feature.held == Some(false) }
}
