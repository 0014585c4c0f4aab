//! The search of all equilibria: of a chain from spread joint angles, of a machine from many places of its tool.

use kinetostat::{
    Equilibrium, MechanismEquilibrium, equilibria,
    equilibrium::{Bounds, Equilibria, SearchSettings, SpreadSettings},
};
use kinetostat_analysis::degenerate::{is_degenerate, keep_one_of_each_shape};
use kinetostat_analysis::serial_chain::SerialChain;
use kinetostat_machining::Warning;

use crate::end_condition::machine::CommandedMachine;
use crate::equilibria::query::EquilibriaQuery;
use crate::ui::background::Stage;
use crate::ui::failure::Answer;

pub(crate) fn of_chain(
    chain: &SerialChain,
    q: &EquilibriaQuery,
    stage: &Stage,
) -> Answer<(Equilibria<Equilibrium>, Vec<Warning>)> {
    stage.is("searching for equilibria");
    let problem = chain.problem(q.end.clone());
    let mut all = equilibria(&problem, &Bounds::of(&chain.chain), &q.settings)?;
    for found in &mut all.found {
        found.singular = is_degenerate(chain, &problem, found);
    }
    keep_one_of_each_shape(&mut all.found);
    Ok((all, Vec::new()))
}

pub(crate) fn of_machine(
    machine: &CommandedMachine,
    q: &EquilibriaQuery,
    stage: &Stage,
) -> Answer<(Equilibria<MechanismEquilibrium>, Vec<Warning>)> {
    stage.is("looking for singular postures nearby");
    let warnings = machine.near_singular(0.0)?;
    stage.is("searching for equilibria");
    let settings = SpreadSettings::default()
        .with_starts(q.settings.starts)
        // A start of a machine costs more than one of a chain.
        .with_fruitless(
            match q.settings.fruitless == SearchSettings::default().fruitless {
                true => SpreadSettings::default().fruitless,
                false => q.settings.fruitless,
            },
        );
    Ok((machine.posture.equilibria(&q.end, &settings)?, warnings))
}
