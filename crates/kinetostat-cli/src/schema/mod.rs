//! `kinetostat schema`: the JSON schema of the results of every command.
//!
//! Each command declares its forms of results beside its code; the list here names them by command.

use clap::Args;
use kinetostat_diagnostic::ErrorCode;
use schemars::generate::SchemaSettings;
use schemars::{Schema, json_schema};

use crate::options::EXIT_CODES;
use crate::ui::failure::{Answer, Failing};
use crate::ui::json::ErrorReport;
use crate::ui::layout::listed;
use crate::ui::result_form::ResultForm;
use crate::ui::screen::{self, Stream};
use crate::{
    assemble, chatter, check, compare, compensate, curve, deflect, demo, dialect, engagement,
    equilibria, force, frf, identify, import, lobes, map, mirror, model, modes, placing,
    plan_measurement, reproduce, shares, stiffness, tolerance, verify,
};

/// Results of each command that has some as JSON.
const COMMANDS: &[(&str, &[ResultForm])] = &[
    ("demo", demo::RESULTS),
    ("compensate", compensate::RESULTS),
    ("verify", verify::RESULTS),
    ("deflect", deflect::RESULTS),
    ("stiffness", stiffness::RESULTS),
    ("view", crate::view::RESULTS),
    ("shares", shares::RESULTS),
    ("modes", modes::RESULTS),
    ("frf", frf::RESULTS),
    ("lobes", lobes::RESULTS),
    ("chatter", chatter::RESULTS),
    ("compare", compare::RESULTS),
    ("map", map::RESULTS),
    ("mirror", mirror::RESULTS),
    ("place", placing::RESULTS),
    ("tolerance", tolerance::RESULTS),
    ("assemble", assemble::RESULTS),
    ("curve", curve::RESULTS),
    ("equilibria", equilibria::RESULTS),
    ("force", force::RESULTS),
    ("engagement", engagement::RESULTS),
    ("dialect", dialect::RESULTS),
    ("check", check::RESULTS),
    ("plan-measurement", plan_measurement::RESULTS),
    ("identify", identify::RESULTS),
    ("import", import::RESULTS),
    ("reproduce", reproduce::RESULTS),
    ("model", model::RESULTS),
    ("error", ERRORS),
];

/// Errors have one form for all commands.
const ERRORS: &[ResultForm] = &[ResultForm::of::<ErrorReport>("errors of any command")];

pub(crate) fn run(args: &SchemaArgs) -> Answer<()> {
    let Some(name) = &args.command else {
        let rows: Vec<Vec<String>> = COMMANDS
            .iter()
            .flat_map(|(name, forms)| {
                let names = std::iter::once(*name).chain(std::iter::repeat(""));
                let rows = names.zip(*forms);
                rows.map(|(name, form)| vec![name.to_owned(), form.title.to_owned()])
            })
            .collect();
        return screen::print(Stream::Out, &listed(&rows, 0));
    };
    let found = COMMANDS.iter().find(|(command, _)| command == name);
    let (command, forms) = found.ok_or_else(|| {
        let names: Vec<&str> = COMMANDS.iter().map(|(command, _)| *command).collect();
        ErrorCode::UnknownName.failure(format!(
            "'{name}' is no command with a result as JSON; there are: {}",
            names.join(", ")
        ))
    })?;
    let text = serde_json::to_string_pretty(&document(command, forms));
    let text = text.map_err(|error| ErrorCode::Internal.failure(format!("the schema: {error}")))?;
    screen::print_bytes(format!("{text}\n").as_bytes())
}

/// The schema of all forms of a command's results.
fn document(command: &str, forms: &[ResultForm]) -> Schema {
    let settings = SchemaSettings::draft2020_12().for_serialize();
    let mut generator = settings.into_generator();
    let mut schemas: Vec<Schema> = forms
        .iter()
        .map(|form| {
            let mut schema = (form.schema)(&mut generator);
            schema.insert("title".to_owned(), form.title.into());
            schema
        })
        .collect();
    let mut root = match schemas.len() {
        1 => schemas.remove(0),
        _ => json_schema!({ "anyOf": schemas }),
    };
    let title = format!("Results of kinetostat {command}");
    root.insert("$schema".to_owned(), DRAFT.into());
    root.insert("title".to_owned(), title.into());
    let definitions = generator.take_definitions(true);
    root.insert("$defs".to_owned(), definitions.into());
    root
}

/// Edition of JSON Schema in which the schemas are written.
const DRAFT: &str = "https://json-schema.org/draft/2020-12/schema";

/// The JSON schema of what a command prints with --json, for programs that read it
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct SchemaArgs {
    /// Name of the command, as in `stiffness`; without it all forms of results are listed
    #[arg(value_name = "COMMAND")]
    pub(crate) command: Option<String>,
}
