//! Every preset loads, and says what its source says.

use kinetostat_model::{Model, preset_names, preset_text};

#[test]
fn every_preset_loads_without_a_warning() {
    for preset in preset_names() {
        match Model::preset(preset.name) {
            Ok(model) => {
                assert_eq!(model.name(), preset.name);
                assert!(model.warnings.is_empty(), "{}", model.warnings[0]);
                assert_eq!(Some(model.text.as_str()), preset_text(preset.name));
            }
            Err(error) => panic!("{error}"),
        }
    }
}
