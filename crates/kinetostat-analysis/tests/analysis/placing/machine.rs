//! Machines whose errors are known in closed form, and what is asked of them.

use kinetostat::{Directions, Mechanism, Wrench};
use kinetostat_machining::{
    Bounds, CuttingLoad, LoadAxes, Placement, ProgramLoad, RunInputs, Task, WeightCorrection,
};
use kinetostat_model::Model;
use kinetostat_program::{Gcode, Program, ReadOptions, WriteOptions, interpret};
use nalgebra::Vector3;

/// N m/rad of the only soft drive of [`swing`].
pub const SOFT: f64 = 1e6;

fn model(elements: &str, home: &str) -> Mechanism {
    let text = format!(
        "schema = 1\n[mechanism]\nname = \"planted\"\n[[platform]]\nname = \"tool\"\nhome = {{ position_mm = {home} }}\n[chain.drives]\nelements = [{elements}]\n[[limb]]\nname = \"drives\"\nfrom = \"base\"\nto = \"tool\"\nchain = \"drives\"\n"
    );
    Model::from_toml(&text, "planted.toml")
        .expect("model")
        .mechanism
}

/// A swinging drive about z with a stiff rail on it, whose reach is 200 to 1200 mm: under a force `F` along x a tip at (x, y) goes by
/// `F |y| sqrt(x^2 + y^2) / SOFT`.
pub fn swing() -> Mechanism {
    let elements = format!(
        "{{ actuator = \"revolute\", name = \"swing\", axis = \"z\", stiffness_n_m_per_rad = {SOFT:e} }}, \
         {{ actuator = \"prismatic\", name = \"rail\", axis = \"x\", stiffness_n_per_mm = 1e9, home_mm = 600, limits_mm = [200, 1200] }}, \
         {{ actuator = \"prismatic\", name = \"lift\", axis = \"z\", stiffness_n_per_mm = 1e9 }}"
    );
    model(&elements, "[600, 0, 0]")
}

/// Drives along x, y and z of these stiffnesses, N/mm.
pub fn rails([x, y, z]: [f64; 3]) -> Mechanism {
    let drive = |axis: &str, stiffness: f64| {
        format!(
            "{{ actuator = \"prismatic\", name = \"{axis}\", axis = \"{axis}\", stiffness_n_per_mm = {stiffness:e} }}"
        )
    };
    let all = [drive("x", x), drive("y", y), drive("z", z)];
    model(&all.join(", "), "[0, 0, 0]")
}

/// The same force along x of the base everywhere, N; it acts from the start of every feed move on.
pub fn along_x(force: f64) -> ProgramLoad {
    at_once(CuttingLoad::Constant {
        axes: LoadAxes::Base,
        wrench: Wrench::new(Vector3::x() * force, Vector3::zeros()),
    })
}

/// To the right of the feed, N.
pub fn to_the_right(radial: f64) -> ProgramLoad {
    at_once(CuttingLoad::Milling {
        radial,
        tangential: 0.0,
        axial: 0.0,
    })
}

fn at_once(cutting: CuttingLoad) -> ProgramLoad {
    ProgramLoad {
        largest_step: f64::INFINITY,
        ..ProgramLoad::new(cutting)
    }
}

/// Asks for a program whose zero lies at x = 600 mm unless a range says something else.
pub fn with_task<T>(
    mechanism: &Mechanism,
    text: &str,
    load: ProgramLoad,
    ask: impl FnOnce(&Task<'_>) -> T,
) -> T {
    let program = Program::read(text).expect("program");
    let path = interpret(&program, &ReadOptions::default()).expect("path");
    let mut placement = Placement::at(Vector3::x() * 0.6);
    placement.orientation_follows = mechanism.turns_as_it_moves();
    ask(&Task {
        mechanism,
        program: &Gcode {
            program: &program,
            path: &path,
            reading: &ReadOptions::default(),
        },
        corrected: Directions::POSITION,
        placement,
        load,
        tools: &[],
        weight: WeightCorrection::All,
        cut: None,
        writing: WriteOptions::default(),
        run_inputs: RunInputs::default(),
        bounds: Bounds::default(),
        places: 0,
        compliances: false,
    })
}
