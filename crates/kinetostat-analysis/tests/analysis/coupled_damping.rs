//! Viscous damping that couples modes: the modal data of a cut, with what has no mass, against the direct solution of all
//! coordinates.

use kinetostat::Wrench;
use kinetostat_analysis::vibration::{MachineCut, VibratingMachine};
use kinetostat_chatter::{Arc, Coefficients, FeedFrame, Milled, MillingCut, Swinging};
use kinetostat_dynamics::{Damping, Held};
use kinetostat_model::Model;
use kinetostat_testing::Worst;
use nalgebra::{Complex, Matrix3};

/// Off by so much of the response at most, beside its resonances (where a mode that no damper moves has none).
const OFF: f64 = 1e-7;

fn machine(name: &str) -> VibratingMachine {
    let mechanism = Model::preset(name).expect("a preset").mechanism;
    let home = mechanism.platforms()[mechanism.tool()].home;
    let posture = mechanism.posture(&home).expect("a posture");
    VibratingMachine::at(&posture, &Wrench::zero(), &Held::nothing()).expect("vibrations")
}

fn size(m: &Matrix3<Complex<f64>>) -> f64 {
    m.map(|x| x.norm()).norm()
}

#[test]
fn the_response_of_a_cut_has_all_of_the_damping() {
    let viscous = |list: &[(&str, f64)]| {
        Damping::Viscous(
            list.iter()
                .map(|(name, c)| ((*name).to_owned(), *c))
                .collect(),
        )
    };
    let rayleigh = Damping::Rayleigh {
        mass_per_s: 0.5,
        stiffness_s: 1e-5,
    };
    let cases = [
        ("heavy_6r", viscous(&[("joint 1", 3e4), ("joint 2", 3e4)])),
        (
            "heavy_6r",
            viscous(&[
                ("joint 1", 3e3),
                ("joint 2", 3e3),
                ("joint 3", 2e3),
                ("joint 4", 300.0),
                ("joint 5", 300.0),
                ("joint 6", 100.0),
            ]),
        ),
        (
            "heavy_6r",
            viscous(&[("joint 2", 300.0), ("joint 3", 2e3), ("joint 5", 50.0)]),
        ),
        ("heavy_6r", rayleigh),
        ("hexapod", viscous(&[("leg 1.screw", 2e4)])),
    ];
    let [mut worst, mut alone, mut of_cut, mut lost] = [(); 4].map(|()| Worst::new());
    let mut count = 0;
    for (name, damping) in cases {
        let machine = machine(name);
        let hz: Vec<f64> = (machine.modes.frequencies_hz().into_iter())
            .take(20)
            .flat_map(|hz| [0.9 * hz, 1.003 * hz])
            .collect();
        let data = machine
            .tool_response(&damping, usize::MAX)
            .and_then(|r| r.translational());
        let data = data.expect("modal data");
        let directly = machine
            .tool_receptance(&damping, None)
            .expect("a direct solution");
        assert_eq!(directly.solution(), "direct", "{name}");
        let directly = directly.over(&hz).expect("a response");
        let by_modes = machine
            .tool_receptance(&damping, Some(usize::MAX))
            .expect("modes");
        let by_modes = by_modes.over(&hz).expect("a response");
        let cut = MachineCut {
            machine: &machine,
            damping: &damping,
            frame: FeedFrame::vertical(0.7).expect("a frame"),
            cut: MillingCut::new(
                2,
                Arc::straight(Milled::Up, 0.5).expect("an arc"),
                Coefficients::new(8e8, 2.4e8, 0.0).expect("coefficients"),
            )
            .expect("a cut"),
            swinging: Swinging::All,
        };
        let turned = cut.frame.rotation().map(Complex::from);
        // Refused where a mode has no damping: there is nothing to tell then.
        let cut = cut.regeneration();
        if cut.is_ok() {
            let told = machine.lost_coupling(&damping, 100.0).expect("a share");
            lost.add_at(told, || format!("{name}, {damping:?}"));
        }
        for ((hz, wanted), own) in hz.iter().zip(&directly).zip(&by_modes) {
            let along =
                |m: &kinetostat_dynamics::Receptance| m.fixed_view::<3, 3>(0, 0).into_owned();
            let wanted = along(wanted);
            let off = |found: &Matrix3<Complex<f64>>| size(&(found - wanted)) / size(&wanted);
            worst.add_at(off(&data.receptance_at_hz(*hz)), || {
                format!("{name}, {hz} Hz, {damping:?}")
            });
            alone.add(off(&along(own)));
            count += 1;
            // Modes that do not swing at all are refused where they count.
            if let Ok(cut) = &cut {
                of_cut.add(off(&(turned
                    * cut.response().receptance(*hz)
                    * turned.transpose())));
            }
        }
    }
    assert!(worst.of(count) < OFF, "{worst}");
    assert!(alone.of(count) > 0.1, "{alone}");
    assert!(of_cut.value() < OFF, "{of_cut}");
    assert!(lost.of(2) < OFF, "{lost}");
    // Structural damping goes by the springs, which the weight has changed: that is no damping of velocities, and told.
    let structural = Damping::Structural { loss_factor: 0.1 };
    let told = machine("heavy_6r").lost_coupling(&structural, 1000.0);
    assert!(told.expect("a share") > 1e-6);
}
