//! Random cases from a seed, each through every query of a chain.

pub mod cases;
pub mod checks;
pub mod platforms;
pub mod random;
mod ratios;
mod reach;
pub mod rod;
pub mod round;
pub mod shapes;
mod struts;

use std::panic::{AssertUnwindSafe, catch_unwind};

use kinetostat::{
    ChainProblem, CurveSettings, Parameter, Prescribed, Settings, Wrench,
    continuation::LoadPattern,
    critical_load_factor, equilibria,
    equilibrium::{Bounds, SearchSettings, StabilityOf},
    follow,
    reference::{
        ChainBlocks, IterationOutcome, IterationSettings, newton_iteration, report_iteration,
        shape_criterion,
    },
    solve_chain, unloaded_stiffness,
};

use cases::Sizes;
use random::Random;

/// What became of a case.
#[derive(Clone, Copy, Debug, Default)]
pub struct Outcome {
    pub chains: usize,
    pub solved: usize,
    pub unsolved: usize,
    pub equilibria: usize,
    pub points: usize,
    pub refused: usize,
}

impl Outcome {
    pub fn add(&mut self, other: Self) {
        self.chains += other.chains;
        self.solved += other.solved;
        self.unsolved += other.unsolved;
        self.equilibria += other.equilibria;
        self.points += other.points;
        self.refused += other.refused;
    }
}

/// Struts, machines on struts, stiffness ratios, stiff links, rods with platforms between, machines of several shapes and
/// round rods: what comes out is known.
fn known(seed: u64, stage: &std::cell::Cell<&'static str>) {
    // Numbers of their own, so that the random chains of a seed stay what they were.
    let mut random = Random::new(seed ^ 0x5eed_0000_0000);
    stage.set("struts");
    struts::case(&mut random);
    stage.set("stiffness ratios");
    ratios::case(&mut random);
    stage.set("stiff links");
    ratios::stiff_link(&mut random);
    if seed.is_multiple_of(3) {
        stage.set("machines reach what chains reach");
        reach::case(&mut random);
    }
    // Further ones, with numbers of their own again.
    let mut random = Random::new(seed ^ 0x5eed_0000_0001);
    match seed % 6 {
        1 => {
            stage.set("stiffness behind platforms");
            platforms::case(&mut random);
        }
        // Exhaustive scans take a second.
        2 if seed % 24 == 2 => {
            stage.set("machines of several shapes");
            shapes::case(&mut random);
        }
        4 => {
            stage.set("round rods");
            round::case(&mut random);
        }
        _ => {}
    }
}

/// Runs one case; a broken promise or a panic comes back in words.
pub fn run(seed: u64, largest: usize) -> Result<Outcome, String> {
    let stage = std::cell::Cell::new("chain");
    let all = || {
        known(seed, &stage);
        stage.set("chain");
        case(seed, largest, &stage)
    };
    catch_unwind(AssertUnwindSafe(all)).map_err(|cause| {
        let words = cause
            .downcast_ref::<String>()
            .cloned()
            .or_else(|| cause.downcast_ref::<&str>().map(|s| (*s).to_owned()))
            .unwrap_or_default();
        format!("seed {seed}, {}: {words}", stage.get())
    })
}

/// The case in words, for repeating it by hand.
pub fn describe(seed: u64, largest: usize) -> String {
    let mut random = Random::new(seed);
    let (sizes, size) = begin(&mut random, largest);
    match cases::chain(&mut random, &sizes, size) {
        Ok(chain) => {
            let problem = cases::problem(&mut random, &sizes, &chain);
            let elements: Vec<String> = chain
                .elements()
                .iter()
                .map(|e| format!("  {e:?}"))
                .collect();
            format!(
                "{sizes:?}\n{}\nsprings {:?}\nbase {:?}\ncommands {:?}\nposture {:?}\nend {:?}\nloads {:?}",
                elements.join("\n"),
                chain.springs(),
                problem.base,
                problem.commands,
                problem.posture,
                problem.end,
                problem.loads
            )
        }
        Err(e) => format!("{sizes:?}: {e}"),
    }
}

fn begin(random: &mut Random, largest: usize) -> (Sizes, usize) {
    let sizes = Sizes::random(random);
    // Mostly small ones: they are as nasty and much faster.
    let share = random.between(0.0, 1.0).powi(2);
    let size = match random.below(40) {
        0 => 0,
        _ => 1 + (share * largest as f64) as usize,
    };
    (sizes, size)
}

fn case(seed: u64, largest: usize, stage: &std::cell::Cell<&'static str>) -> Outcome {
    let mut random = Random::new(seed);
    let (sizes, size) = begin(&mut random, largest);
    let mut outcome = Outcome::default();
    let chain = match cases::chain(&mut random, &sizes, size) {
        Ok(chain) => chain,
        Err(e) => {
            checks::explained(&e, "chain 'random'", false);
            outcome.refused += 1;
            return outcome;
        }
    };
    outcome.chains += 1;
    let mut problem = cases::problem(&mut random, &sizes, &chain);
    let n = chain.coordinate_count();

    stage.set("unloaded_stiffness");
    match unloaded_stiffness(&chain, &problem.base, &problem.posture, &problem.commands) {
        Ok(k) => checks::stiffness(&k),
        Err(e) => checks::explained(&e, "chain 'random'", false),
    }

    if random.once_in(3) {
        stage.set("three ways to a stiffness");
        let here = (&problem.base, &problem.posture, &problem.commands);
        match ChainBlocks::unloaded(&chain, here.0, here.1, here.2) {
            Ok(blocks) => checks::blocks(&blocks),
            Err(e) => checks::explained(&e, "chain 'random'", false),
        }
    }

    if random.once_in(20) {
        stage.set("a description that is no chain");
        let what = cases::wrong_chain(&mut random, &sizes);
        match what {
            (what, Ok(_)) => panic!("{what} was accepted"),
            (_, Err(e)) => checks::explained(&e, "chain 'wrong'", true),
        }
        outcome.refused += 1;
    }

    if random.once_in(20) {
        stage.set("odd settings");
        odd_settings(&mut random, &problem);
    }

    if random.once_in(15) {
        stage.set("huge numbers");
        huge(&mut random, &problem);
    }

    if random.once_in(12) {
        stage.set("spoilt input");
        let what = cases::spoil(&mut random, &mut problem);
        match solve_chain(&problem, &Settings::default()) {
            Ok(_) => panic!("a spoilt {what} was accepted"),
            Err(e) => checks::explained(&e, "", true),
        }
        outcome.refused += 1;
        return outcome;
    }

    stage.set("solve_chain");
    let start = match solve_chain(&problem, &Settings::default()) {
        Ok(e) => {
            checks::equilibrium(&problem, &e, 1e-7);
            outcome.solved += 1;
            Some(e)
        }
        Err(e) => {
            checks::explained(&e, "chain 'random'", false);
            outcome.unsolved += 1;
            None
        }
    };

    if let Some(e) = start.as_ref().filter(|_| random.once_in(3)) {
        stage.set("three ways to a loaded stiffness, shape criterion");
        match ChainBlocks::loaded(&problem, e) {
            Ok(blocks) => checks::blocks(&blocks),
            Err(e) => checks::explained(&e, "", false),
        }
        match shape_criterion(&problem, e, sizes.length) {
            Ok(s) => {
                let numbers = s.matrix.iter().chain(s.basis.iter()).chain(&s.eigenvalues);
                assert!(numbers.copied().all(f64::is_finite), "{s:?}");
            }
            Err(e) => checks::explained(&e, "'random'", false),
        }
    }

    if random.once_in(4) {
        stage.set("report_iteration and newton_iteration");
        let settings = IterationSettings::default().with_steps(30);
        for iteration in [
            report_iteration(&problem, None, &settings),
            newton_iteration(&problem, None, &settings),
        ] {
            match iteration {
                Ok(i) => {
                    for e in i.equilibrium.iter().chain(&i.nearest) {
                        checks::equilibrium(&problem, e, 1e-7);
                    }
                    let rates = [i.observed_rate, i.expected_rate, i.rate_at_start];
                    assert!(rates.iter().flatten().all(|r| !r.is_nan()), "{rates:?}");
                    let numbers = i.path.iter().flat_map(|s| s.coordinates.iter());
                    let finite = numbers.clone().all(|x| x.is_finite());
                    assert!(finite || i.outcome == IterationOutcome::Diverged);
                    assert!(!i.words().contains("NaN"));
                }
                Err(e) => checks::explained(&e, "", false),
            }
        }
    }

    if n <= 16 && random.once_in(4) {
        stage.set("equilibria");
        let settings = SearchSettings::default()
            .with_fruitless(4)
            .with_starts(12)
            .with_most(4)
            .with_sweep(random.once_in(3))
            .with_solver(Settings::default().with_iterations(25));
        match equilibria(&problem, &Bounds::of(&chain), &settings) {
            Ok(all) => {
                for found in &all.found {
                    checks::equilibrium(&problem, &found.equilibrium, 1e-7);
                    assert!(
                        found.potential.is_none_or(f64::is_finite),
                        "{:?}",
                        found.potential
                    );
                    outcome.equilibria += 1;
                }
                assert!(
                    (0.0..=1.0).contains(&all.chance_of_more),
                    "{}",
                    all.chance_of_more
                );
                assert!((0.0..=1.0).contains(&all.chance_of_more_at_most));
            }
            Err(e) => checks::explained(&e, "", false),
        }
    }

    if let Some(start) = start.filter(|_| n <= 24 && random.once_in(3)) {
        stage.set("follow");
        let parameter = parameter(&mut random, &problem, &sizes);
        let range = match &parameter {
            Parameter::Displacement(_) => sizes.length,
            Parameter::Load(_) => 2.0,
        };
        let mut settings = CurveSettings::within(-range, range);
        settings.points = 5;
        settings.branches = 1 + random.below(2);
        match follow(&problem, &parameter, &start, 0.0, &settings) {
            Ok(curves) => {
                let points = curves.branches.iter().flat_map(|b| &b.points);
                for p in points.chain(curves.specials.iter().map(|s| &s.point)) {
                    outcome.points += 1;
                    point(&problem, &parameter, p);
                }
                for s in &curves.specials {
                    assert!(s.mode.iter().all(|x| x.is_finite()), "{:?}", s.mode);
                    assert!(!s.accuracy.is_nan());
                }
            }
            Err(e) => checks::explained(&e, "", false),
        }
        if let Parameter::Load(pattern) = &parameter
            && random.once_in(2)
        {
            stage.set("critical_load_factor");
            critical(&mut random, &problem, pattern);
        }
    }
    outcome
}

/// The checks themselves notice an equilibrium that is none: a coordinate is moved by a small share
/// of its range. Returns whether the case had an equilibrium in which that must be seen.
pub fn notices(seed: u64) -> Option<bool> {
    let mut random = Random::new(seed);
    let (sizes, size) = begin(&mut random, 12);
    let chain = cases::chain(&mut random, &sizes, size).ok()?;
    let problem = cases::problem(&mut random, &sizes, &chain);
    let mut e = solve_chain(&problem, &Settings::default()).ok()?;
    let springs = chain.indices_of(kinetostat::model::Role::Spring);
    let held = problem.end.prescribed == [Prescribed::Pose; 6];
    if springs.is_empty() || !held || e.stiffness.count(kinetostat::DirectionKind::Rigid) > 0 {
        return None;
    }
    let moved = springs[random.below(springs.len())];
    let unit = match chain.coordinates()[moved].kind {
        kinetostat::MotionKind::Prismatic => sizes.length,
        kinetostat::MotionKind::Revolute => 1.0,
    };
    e.coordinates[moved] += 1e-4 * unit;
    // Poses of the moved chain, so that the conditions have to see it.
    let x = &e.coordinates;
    let k = kinetostat::model::Kinematics::new(&chain, &problem.base, x, &problem.commands);
    e.nodes = (0..chain.nodes().len()).map(|i| k.node_pose(i)).collect();
    e.tip = k.tip_pose();
    let broken = catch_unwind(AssertUnwindSafe(|| checks::equilibrium(&problem, &e, 1e-7)));
    Some(broken.is_err())
}

/// One finite number far beyond all sense: what comes back is finite, or an error.
fn huge(random: &mut Random, problem: &ChainProblem<'_>) {
    let mut problem = problem.clone();
    let size = random.power(15.0, 300.0) * if random.once_in(2) { 1.0 } else { -1.0 };
    let n = problem.posture.len();
    match random.below(5) {
        0 if n > 0 => problem.posture[random.below(n)] = size,
        1 if !problem.commands.is_empty() => problem.commands[0] = size,
        2 => problem.end.pose.translation.vector.y = size,
        3 => problem.base.translation.vector.x = size,
        _ => problem.end.wrench.0[random.below(6)] = size,
    }
    let chain = problem.chain;
    match unloaded_stiffness(chain, &problem.base, &problem.posture, &problem.commands) {
        Ok(k) => checks::stiffness(&k),
        Err(e) => checks::explained(&e, "chain 'random'", true),
    }
    match solve_chain(&problem, &Settings::default()) {
        Ok(e) => {
            checks::finite(&e);
            if let Ok(blocks) = ChainBlocks::loaded(&problem, &e) {
                checks::blocks(&blocks);
            }
        }
        Err(e) => checks::explained(&e, "chain 'random'", true),
    }
    for iteration in [report_iteration, newton_iteration] {
        match iteration(&problem, None, &IterationSettings::default().with_steps(10)) {
            Ok(i) => i
                .equilibrium
                .iter()
                .chain(&i.nearest)
                .for_each(checks::finite),
            Err(e) => checks::explained(&e, "", true),
        }
    }
}

/// Settings that nobody would choose: an answer or an error that explains itself, never a panic.
fn odd_settings(random: &mut Random, problem: &ChainProblem<'_>) {
    let odd = |random: &mut Random| [0.0, -1.0, f64::NAN, f64::INFINITY, 1e300][random.below(5)];
    let solver = Settings::default()
        .with_closure(odd(random))
        .with_torque(odd(random))
        .with_iterations(random.below(3))
        .with_picard_steps(random.below(4))
        .with_smallest_load_step([0.3, odd(random)][random.below(2)]);
    let start = match solve_chain(problem, &solver) {
        Ok(e) => Some(e),
        Err(e) => {
            checks::explained(&e, "", true);
            None
        }
    };
    let settings = IterationSettings::default()
        .with_tolerance(odd(random))
        .with_steps(random.below(3));
    for iteration in [
        report_iteration(problem, None, &settings),
        newton_iteration(problem, None, &settings),
    ] {
        match iteration {
            Ok(i) => assert!(!i.words().contains("NaN")),
            Err(e) => checks::explained(&e, "", true),
        }
    }
    let mut bounds = Bounds::of(problem.chain);
    match random.below(4) {
        0 => bounds.low.push(0.0),
        1 => bounds.high.iter_mut().for_each(|x| *x = odd(random)),
        2 => bounds.low.iter_mut().for_each(|x| *x = f64::NAN),
        _ => {}
    }
    let search = SearchSettings::default()
        .with_fruitless(random.below(2))
        .with_starts(random.below(3))
        .with_most(random.below(3))
        .with_sweep(random.once_in(2))
        .with_solver(solver);
    if problem.chain.coordinate_count() <= 12
        && let Err(e) = equilibria(problem, &bounds, &search)
    {
        checks::explained(&e, "", true);
    }
    let Some(start) = start.filter(|_| problem.chain.coordinate_count() <= 12) else {
        return;
    };
    let held = (0..6).find(|&k| problem.end.prescribed[k] == Prescribed::Pose);
    let parameter = Parameter::along(&problem.end.axes, held.unwrap_or(0));
    let mut curve = CurveSettings::within(odd(random), odd(random));
    curve.points = random.below(4);
    curve.branches = random.below(3);
    curve.largest_turn = [0.1, odd(random)][random.below(2)];
    curve.largest_angle = [1.0, odd(random)][random.below(2)];
    curve.smallest_step = [1e-7, odd(random)][random.below(2)];
    curve.largest_change = [None, Some(odd(random))][random.below(2)];
    if let Err(e) = follow(problem, &parameter, &start, odd(random), &curve) {
        checks::explained(&e, "", true);
    }
}

fn critical(random: &mut Random, problem: &ChainProblem<'_>, pattern: &LoadPattern) {
    let mut settings = CurveSettings::within(0.0, 10.0);
    settings.points = 5;
    let stability_of = [StabilityOf::Shape, StabilityOf::ShapeAndEnd][random.below(2)];
    match critical_load_factor(problem, pattern, stability_of, &settings) {
        Ok(c) => {
            assert!(
                c.linear.is_none_or(|f| f.is_finite() && f > 0.0),
                "{:?}",
                c.linear
            );
            assert!(c.linear_mode.iter().all(|x| x.is_finite()));
            assert!(!c.reached.is_nan());
            if let Some(p) = c.exact {
                assert!(p.factor.is_finite(), "{}", p.factor);
                assert!(p.mode.iter().all(|x| x.is_finite()));
                point_at(
                    problem,
                    &Parameter::Load(pattern.clone()),
                    p.factor,
                    &p.equilibrium,
                );
            }
        }
        Err(e) => checks::explained(&e, "", false),
    }
}

/// What grows: a load pattern, or the end along a direction in which it is held.
fn parameter(random: &mut Random, problem: &ChainProblem<'_>, sizes: &Sizes) -> Parameter {
    let held: Vec<usize> = (0..6)
        .filter(|&k| problem.end.prescribed[k] == Prescribed::Pose)
        .collect();
    if !held.is_empty() && random.once_in(2) {
        return Parameter::along(&problem.end.axes, held[random.below(held.len())]);
    }
    let other = cases::problem(random, sizes, problem.chain);
    let mut end = Wrench::zero();
    if held.is_empty() {
        end = other.end.wrench;
    }
    Parameter::Load(LoadPattern {
        end,
        loads: other.loads,
    })
}

fn point(
    problem: &ChainProblem<'_>,
    parameter: &Parameter,
    p: &kinetostat::continuation::CurvePoint,
) {
    assert!(p.parameter.is_finite(), "parameter {}", p.parameter);
    assert!(p.conjugate.is_finite(), "conjugate {}", p.conjugate);
    assert!(p.arc.is_finite(), "arc {}", p.arc);
    assert!(!p.slope.is_nan(), "slope is NaN");
    let n = problem.chain.coordinate_count();
    checks::stability(&p.displacement_control, n);
    checks::stability(&p.dead_load, n);
    point_at(problem, parameter, p.parameter, &p.equilibrium);
}

/// The equilibrium of the problem with the parameter at a value.
fn point_at(
    problem: &ChainProblem<'_>,
    parameter: &Parameter,
    value: f64,
    e: &kinetostat::Equilibrium,
) {
    let mut here = problem.clone();
    match parameter {
        Parameter::Displacement(twist) => {
            let span = kinetostat::Twist(twist.0 * value);
            here.end.pose = kinetostat::spatial::moved(&problem.end.pose, &span);
        }
        Parameter::Load(pattern) => {
            here.end.wrench = Wrench(problem.end.wrench.0 + pattern.end.0 * value);
            for load in &pattern.loads {
                here.loads.push(cases::scaled(load, value));
            }
        }
    }
    checks::equilibrium(&here, e, 1e-7);
}
