//! The curve of a machine of several limbs or platforms: its tool is moved or loaded, all limbs follow.

use kinetostat::{
    CurveSettings, EndCondition,
    continuation::{BranchEnd, MachinePath, PathPoint, PathSpecial, PathSpecialKind},
};
use kinetostat_machining::{Warning, WarningCode};

use crate::curve::answer::{
    BranchAnswer, CurveAnswer, JumpAnswer, NamedPoint, PointAnswer, Units, grows, letter, reached,
};
use crate::curve::arguments::CurveArgs;
use crate::curve::query::{CurveQuery, Measure};
use crate::curve::state::CurveState;
use crate::end_condition::loads::refuse_nodes;
use crate::end_condition::machine::CommandedMachine;
use crate::place::query::PlaceAnswer;
use crate::ui::background::Stage;
use crate::ui::failure::{Answer, Failure};

/// Options that are for chains.
pub(crate) fn refuse(args: &CurveArgs) -> Answer<()> {
    refuse_nodes(&args.end)?;
    if args.all || args.branches.is_some() {
        return Err(Failure::input(
            "--all and --branches are for models of one limb; of a machine of several limbs the branch of the start is followed. `kinetostat equilibria` searches for others",
        ));
    }
    Ok(())
}

/// Follows the curve of a machine.
pub(crate) fn solve(
    machine: &CommandedMachine,
    q: &CurveQuery,
    place: PlaceAnswer,
    names: [String; 3],
    stage: &Stage,
) -> Answer<CurveAnswer> {
    let posture = machine.posture()?;
    let mut settings = CurveSettings::within(q.range.0, q.range.1);
    settings.points = q.points;
    settings.largest_change = Some((q.range.1 - q.range.0) / 60.0);
    if let Some(limits) = q.force_limits {
        settings.conjugate_range = limits;
    }
    stage.is("looking for singular postures nearby");
    let far = match q.measure {
        Measure::Force(_) if !q.by_load() => q.range.0.abs().max(q.range.1.abs()),
        _ => 0.0,
    };
    let mut warnings = machine.near_singular(&posture, far)?;
    stage.is("following the curve");
    let end: &EndCondition = &q.holding.end;
    let path = posture.path(&q.parameter, end, &settings)?;
    let point = |p: &PathPoint| -> PointAnswer {
        let e = &p.equilibrium;
        CurveState {
            parameter: p.parameter,
            conjugate: p.conjugate,
            slope: p.slope,
            stable: [p.dead, p.held],
            may_flutter: p.may_flutter,
            share_to_buckling: e.share_to_buckling(),
            energy: e.limbs.iter().map(|l| l.energy).sum(),
            wrench: e.wrench,
            tip: e.tool,
            coordinates: machine.values(&posture, e),
        }
        .answer(q, 0.0)
    };
    let (named_points, jumps) = named(&path, &point);
    warnings.extend(of_ends(&path, q));
    let own = path.points.iter().map(|p| q.shown(p.parameter));
    let [model, model_source, tool] = names;
    Ok(CurveAnswer {
        schema: 3,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        model,
        model_source,
        tool,
        place,
        question: q.words.clone(),
        tool_held: q.holding.clone(),
        grows: grows(q),
        coordinates: machine.coordinates(&posture),
        named_points,
        jumps,
        critical_loads: Vec::new(),
        branches: vec![BranchAnswer {
            number: 1,
            from: None,
            ends: path.ends,
            points: path.points.iter().map(point).collect(),
        }],
        more_branches: false,
        conservative: path.points.iter().all(|p| p.equilibrium.conservative),
        warnings,
        subject: q.holding.subject,
        units: Units::of(q),
        requested: (q.shown(q.range.0), q.shown(q.range.1)),
        reached: reached(own),
    })
}

/// Why a path ends where it was not asked to.
fn of_ends(path: &MachinePath, q: &CurveQuery) -> Vec<Warning> {
    let mut list: Vec<Warning> = Vec::new();
    for end in path.ends {
        let said = match end {
            BranchEnd::Lost => {
                "the curve was lost: beyond its end no further equilibrium was found".to_owned()
            }
            BranchEnd::Points => format!(
                "the curve ends after {} points; --points N allows more, --force-limits keeps it shorter",
                q.points
            ),
            _ => continue,
        };
        list.push(Warning::new(WarningCode::CurveEnds, said));
    }
    if path
        .specials
        .iter()
        .any(|s| s.kind == PathSpecialKind::Crossing)
    {
        list.push(Warning::new(
            WarningCode::MoreBranches,
            "where stability changes without a limit another branch crosses; of a machine of several limbs only the branch of the start is followed",
        ));
    }
    list.dedup();
    list
}

/// Points with names, and the jumps between them.
fn named(
    path: &MachinePath,
    point: &dyn Fn(&PathPoint) -> PointAnswer,
) -> (Vec<NamedPoint>, Vec<JumpAnswer>) {
    let mut list: Vec<NamedPoint> = Vec::new();
    let mut add = |kind: &'static str, words: String, p: &PathPoint, limits: [bool; 2]| {
        let name = letter(list.len());
        list.push(NamedPoint {
            name: name.clone(),
            kind,
            in_words: words,
            branches: vec![1],
            mode: Vec::new(),
            mode_in_words: String::new(),
            limits,
            point: point(p),
        });
        name
    };
    add(
        "start",
        "where the curve starts".into(),
        &path.points[path.start],
        [false; 2],
    );
    let specials: Vec<String> = path
        .specials
        .iter()
        .map(|s| {
            let kind = match s.kind {
                PathSpecialKind::LoadLimit => "load_limit",
                PathSpecialKind::DisplacementLimit => "displacement_limit",
                PathSpecialKind::Crossing => "crossing",
            };
            let [held, dead] = s.ends;
            add(kind, special_in_words(s), &s.point, [dead, held])
        })
        .collect();
    let mut jumps = Vec::new();
    for jump in &path.jumps {
        let from = specials[jump.from].clone();
        let (under, words) = match jump.dead_load {
            true => ("dead_load", "under a dead load"),
            false => ("prescribed_motion", "under prescribed motion"),
        };
        let to = jump.to.iter().map(|p| {
            let words = format!("where the jump from {from} {words} may land");
            add("landing", words, p, [false; 2])
        });
        let to = to.collect();
        jumps.push(JumpAnswer { from, under, to });
    }
    for (p, end) in [path.points.first(), path.points.last()]
        .into_iter()
        .zip(path.ends)
    {
        let words = match end {
            BranchEnd::Points => "as many points as allowed",
            BranchEnd::Lost => "no further point was found",
            _ => "leaves the range",
        };
        let start = &path.points[path.start];
        if let Some(p) =
            p.filter(|p| p.parameter != start.parameter || p.conjugate != start.conjugate)
        {
            let words = format!("end of branch 1: {words}");
            add("end", words, p, [false; 2]);
        }
    }
    (list, jumps)
}

fn special_in_words(s: &PathSpecial) -> String {
    let [held, dead] = s.ends;
    let tail = ", on a part of the curve that is unstable anyway";
    match s.kind {
        PathSpecialKind::LoadLimit if dead => {
            "the load has its extreme here: under a dead load the machine snaps".into()
        }
        PathSpecialKind::LoadLimit => format!("extreme of the load{tail}"),
        PathSpecialKind::DisplacementLimit if held => {
            "the motion has its extreme here: under prescribed motion the machine snaps".into()
        }
        PathSpecialKind::DisplacementLimit => format!("extreme of the motion{tail}"),
        PathSpecialKind::Crossing => {
            let what = match (held, dead) {
                (true, true) => "held or under a dead load",
                (true, false) => "while the motion is prescribed",
                _ => "under a dead load",
            };
            format!(
                "stability changes here ({what}), and the load has no limit: another branch crosses"
            )
        }
    }
}
