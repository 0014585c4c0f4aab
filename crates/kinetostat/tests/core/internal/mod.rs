//! Parts of the core that its interface does not show, each by itself.

mod along_path;
mod bilinear;
mod block_elimination;
mod conformance;
mod derivatives;
mod divergence;
mod heavy_bars;
mod kernels;
mod kernels_newton;
mod krylov;
mod logarithm;
mod masses_along_links;
mod numbers_in_text;
mod poses_and_wrenches;
mod saddle;
mod shortest_solutions;
mod springs;
mod sweeps;
mod sweeps_of_whole_chains;

use kinetostat::{Mechanism, Posture, PostureRequest, machine::LimbPosture, model::unloaded_tip};

/// A serial machine whose drives stand at these commands, its springs at rest.
fn posture_at_joints(machine: &Mechanism, commands: &[f64]) -> Posture {
    let limb = &machine.limbs()[0];
    let joints = LimbPosture {
        commands: commands.to_vec(),
        coordinates: limb.nominal.home_coordinates(),
    };
    let base = machine.platforms()[limb.from].home;
    let tip = unloaded_tip(&limb.nominal, &base, &joints.coordinates, &joints.commands);
    let target = tip * limb.platform_from_tip.inverse();
    let posture = machine.posture(PostureRequest::joints(&target, vec![joints]));
    posture.expect("a posture")
}
