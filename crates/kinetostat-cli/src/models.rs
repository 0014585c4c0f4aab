//! `kinetostat model`: presets and the format of model files.

use kinetostat_model::{Model, json_schema, preset_names, preset_text};

use crate::args::{ModelAction, ModelArgs};
use crate::failure::{Answer, Failure};
use crate::screen::{self, Stream, listed};

pub(crate) fn run(args: &ModelArgs) -> Answer<()> {
    match &args.action {
        ModelAction::List => {
            let mut out = String::new();
            for preset in preset_names() {
                out.push_str(&format!("{}\n", preset.name));
                out.push_str(&screen::wrapped(preset.description, 4));
            }
            out.push_str("\nNext\n");
            out.push_str(&listed(
                &[
                    ["kinetostat check NAME", "what it is, in words"],
                    [
                        "kinetostat model show NAME > my.toml",
                        "a start for your own",
                    ],
                ]
                .map(|row| row.map(str::to_owned).to_vec()),
                2,
            ));
            screen::print(Stream::Out, &out)
        }
        ModelAction::Show { name } => match preset_text(name) {
            Some(text) => screen::print_bytes(text.as_bytes()),
            None => Err(match Model::preset(name) {
                Err(error) => error.into(),
                Ok(_) => Failure::input(format!("there is no preset named '{name}'")),
            }),
        },
        ModelAction::Schema => screen::print_bytes(json_schema().as_bytes()),
    }
}
