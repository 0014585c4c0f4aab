//! `kinetostat model`: presets and the format of model files, drawings, and two models compared.
//!
//! It takes the names of models and gives lists, text, a drawing, or the constant offsets between two of them.

pub(crate) mod arguments;
pub(crate) mod compare;
mod draw;

use kinetostat_diagnostic::ErrorCode;
use kinetostat_model::{Model, PresetKind, json_schema, preset_names, preset_text};

use crate::model::arguments::{ModelAction, ModelArgs};
use crate::ui::failure::{Answer, Failing};
use crate::ui::layout::{self, listed};
use crate::ui::result_form::ResultForm;
use crate::ui::screen::{self, Stream};

/// Results that the command gives as JSON.
pub(crate) const RESULTS: &[ResultForm] = &[ResultForm::of::<compare::Comparison>(
    "two models as one machine",
)];

pub(crate) fn run(args: &ModelArgs) -> Answer<()> {
    match &args.action {
        ModelAction::List => screen::print(Stream::Out, &list()),
        ModelAction::Show { name } => match preset_text(name) {
            Some(text) => screen::print_bytes(text.as_bytes()),
            None => Err(match Model::preset(name) {
                Err(error) => error.into(),
                Ok(_) => {
                    ErrorCode::UnknownName.failure(format!("there is no preset named '{name}'"))
                }
            }),
        },
        ModelAction::Compare { a, b, json } => compare::run(a, b, *json),
        ModelAction::Draw(args) => draw::run(args),
        ModelAction::Schema => screen::print_bytes(json_schema().as_bytes()),
    }
}

/// The presets under the headings of their kinds, and what to do with them.
fn list() -> String {
    let mut out = String::new();
    for kind in PresetKind::ALL {
        let of_kind = || preset_names().iter().filter(|p| p.kind == kind);
        if of_kind().next().is_none() {
            continue;
        }
        out.push_str(&format!("{}\n", kind.heading()));
        for preset in of_kind() {
            out.push_str(&format!("  {}\n", preset.name));
            out.push_str(&layout::wrapped(preset.description, 6));
        }
        out.push('\n');
    }
    out.push_str("Next\n");
    out.push_str(&listed(
        &[
            ["kinetostat check NAME", "what it is, in words"],
            ["kinetostat model draw NAME --out NAME.svg", "a drawing"],
            [
                "kinetostat model show NAME > my.toml",
                "a start for your own",
            ],
        ]
        .map(|row| row.map(str::to_owned).to_vec()),
        2,
    ));
    out
}
