//! Machines of three drives that give way as stated, and by nothing else: every answer is a force over a stiffness.

use kinetostat::Mechanism;
use kinetostat_model::Model;

/// Drives along x, y and z, one after the other, with stiffnesses in N/mm.
pub fn machine(stiffness: [f64; 3]) -> Mechanism {
    let [x, y, z] = stiffness;
    let text = format!(
        r#"
schema = 1
[mechanism]
name = "springs"
[[platform]]
name = "tool"
home = {{ position_mm = [0, 0, 0] }}
[chain.drives]
elements = [
  {{ actuator = "prismatic", name = "x", axis = "x", stiffness_n_per_mm = {x:e} }},
  {{ actuator = "prismatic", name = "y", axis = "y", stiffness_n_per_mm = {y:e} }},
  {{ actuator = "prismatic", name = "z", axis = "z", stiffness_n_per_mm = {z:e} }},
]
[[limb]]
name = "drives"
from = "base"
to = "tool"
chain = "drives"
"#
    );
    Model::from_toml(&text, "springs.toml")
        .expect("model")
        .mechanism
}

/// So stiff that it does not give way.
pub const STIFF: f64 = 1e9;
