//! A load that comes and goes as fast as the correction may change, and no faster.
//!
//! A correction that jumps would move the tool while it stands at one place of the part: a plunge would go up before it goes
//! down. The load may therefore change only by what moves the tool by [`ProgramLoad::largest_step`] per mm of path, at the
//! machine's smallest stiffness against a force. The change goes into the air before and after a cut, where it does not matter
//! where the tool is; a stated load, of which nobody knows where it begins, comes over the first millimetres after a rapid,
//! round corners too. Only where there is less feed than that between two rapids it comes faster: all of it acts before the
//! second one. At sharp corners the load turns while the tool steps, as everywhere.

use std::collections::BTreeMap;

use kinetostat::Wrench;
use kinetostat::number::larger;
use kinetostat_program::{Curve, Move, MoveKind, Path};

use crate::cut::profile::Scale;
use crate::cut::station::SHORT_MM;
use crate::load::along_path::LoadAlongPath;
use crate::load::law::{CuttingLoad, ProgramLoad};
use crate::load::ramp_findings::{LoadBegins, RampFindings, TooFast};
use crate::profile::{Begins, ByMove, Place, Profile, SinceRapid, comes_over_mm, limited, reduced};

/// A load in two readings.
#[derive(Clone, Debug)]
pub(crate) struct Ramped<'a> {
    /// Load that the correction follows.
    pub followed: LoadAlongPath<'a>,
    /// Load that acts: in a cut the computed one, as far as its place is known.
    pub acting: LoadAlongPath<'a>,
    pub findings: RampFindings,
}

impl<'a> Ramped<'a> {
    /// The correction follows all of the load that acts.
    fn alike(load: LoadAlongPath<'a>, findings: RampFindings) -> Self {
        Self {
            acting: load.clone(),
            followed: load,
            findings,
        }
    }
}

impl<'a> LoadAlongPath<'a> {
    /// The load that changes no faster than it may on a machine of this smallest stiffness (N/mm).
    pub(crate) fn ramped(self, stiffness: f64) -> Ramped<'a> {
        let steps = stiffness > 0.0 && stiffness.is_finite();
        if !steps {
            return Ramped::alike(self, RampFindings::default());
        }
        let mut findings = RampFindings::default();
        let begun = self.begun(stiffness, &mut findings);
        let followed = self.with_part(begun);
        let changed = followed.cut.as_ref().and_then(|cut| {
            let limit = Limit {
                load: &followed,
                scale: cut.scale,
                stiffness,
                resolution_mm: cut.resolution_mm,
            };
            limit.cut(&cut.profile, &mut findings)
        });
        let Some((asked, acting)) = changed else {
            return Ramped::alike(followed, findings);
        };
        Ramped {
            acting: followed.clone().with_profile(acting),
            followed: followed.with_profile(asked),
            findings,
        }
    }

    /// The part of stated loads that acts, along the path; `None` where nothing is stated.
    fn begun(&self, stiffness: f64, findings: &mut RampFindings) -> Option<Profile<1>> {
        let stated = |i: usize| stated_force(self.load_of(i));
        let path = self.path();
        if !(0..path.moves.len()).any(|i| stated(i).is_some()) {
            return None;
        }
        let mut all = vec![Vec::new(); path.moves.len()];
        let begins = begins(path);
        for run in runs(path, |_, _| true) {
            let Some(force) = stated(run[0]) else {
                continue;
            };
            let load = self.load_of(run[0]);
            let rate = [load.largest_step * stiffness / force];
            let places = of_run(path, &run, |i| stated_part(load, &path.moves[i]));
            let begins = begins[run[0]];
            let own = match load.below_z_mm {
                Some(_) => LoadBegins::BelowHeight,
                None => LoadBegins::AfterRapid,
            };
            findings.begins(path, &run, begins, own, comes_over_mm(&places, &rate));
            for found in limited(&places, &rate, begins).unwrap_or_default() {
                let place = &found.place;
                all[place.move_index].push((place.share, found.value));
            }
        }
        let mut profile = ByMove::new();
        for own in all {
            profile.push(reduced(&own, |[off]| off.abs() / PART));
        }
        Some(profile)
    }
}

/// A part of a stated load that does not matter.
const PART: f64 = 1e-4;

/// Size of a force that is the same everywhere, N.
fn stated_force(load: &ProgramLoad) -> Option<f64> {
    let force = match load.cutting {
        CuttingLoad::Constant { wrench, .. } => wrench.force().norm(),
        CuttingLoad::Milling {
            radial,
            tangential,
            axial,
        } => radial.hypot(tangential).hypot(axial),
        _ => 0.0,
    };
    (force > 0.0 && force.is_finite()).then_some(force)
}

/// Shares of a move with the part of the load there, and whether it counts: below the height that was stated.
fn stated_part(load: &ProgramLoad, motion: &Move) -> Vec<(f64, [f64; 1], bool)> {
    let Some(z) = load.below_z_mm else {
        return vec![(0.0, [1.0], true), (1.0, [1.0], true)];
    };
    let mut shares = match &motion.curve {
        Curve::Line => crossing(motion, z).into_iter().collect(),
        Curve::Arc(_) => motion.shares_at(2, &[z]),
    };
    shares.retain(|share| *share > 0.0 && *share < 1.0);
    shares.sort_by(f64::total_cmp);
    shares.insert(0, 0.0);
    shares.push(1.0);
    let stretches = shares.windows(2).flat_map(|pair| {
        let inside = motion.point(0.5 * (pair[0] + pair[1])).z < z;
        let part = [f64::from(u8::from(inside))];
        [(pair[0], part, inside), (pair[1], part, inside)]
    });
    stretches.collect()
}

/// Share at which a straight move passes a height.
fn crossing(motion: &Move, z: f64) -> Option<f64> {
    let (from, to) = (motion.start.z - z, motion.end.z - z);
    (from * to < 0.0).then(|| from / (from - to))
}

/// Maximum rate of change of the force of a cut.
struct Limit<'l, 'a> {
    load: &'l LoadAlongPath<'a>,
    scale: Scale,
    stiffness: f64,
    resolution_mm: f64,
}

/// Vertices of the moves on which a profile is another.
type Changed = Vec<Option<Vec<(f64, [f64; 6])>>>;

/// A profile to be followed, and that which acts.
type Followed = (Profile<6>, Profile<6>);

impl Limit<'_, '_> {
    /// `None` where nothing changes too fast.
    fn cut(&self, cut: &Profile<6>, findings: &mut RampFindings) -> Option<Followed> {
        let path = self.load.path();
        let count = path.moves.len();
        let mut asked: Changed = vec![None; count];
        let mut acting = asked.clone();
        let mut by_line: BTreeMap<usize, f64> = BTreeMap::new();
        let (stated, resolution) = match self.resolution_mm.is_infinite() {
            true => (true, 0.0),
            false => (false, self.resolution_mm),
        };
        let joined = |a: &Move, b: &Move| match (a.tangent(1.0), b.tangent(0.0)) {
            (Some(from), Some(to)) => from.angle(&to) <= self.load.base_load().gentle_corner,
            _ => true,
        };
        let begins = begins(path);
        for run in runs(path, joined) {
            let load = self.load.load_of(run[0]);
            if !matches!(load.cutting, CuttingLoad::FromCut { .. }) {
                continue;
            }
            let places = of_run(path, &run, |i| self.vertices(cut, i));
            let rate = self.rate(load);
            // A force that is known to act where a rapid ends acts there at once.
            let begins = match stated {
                true => begins[run[0]],
                false => Begins::Anyhow,
            };
            let needs_mm = comes_over_mm(&places, &rate);
            findings.begins(path, &run, begins, LoadBegins::AfterRapid, needs_mm);
            let Some(found) = limited(&places, &rate, begins) else {
                continue;
            };
            for found in found {
                let (place, value) = (&found.place, found.value);
                let i = place.move_index;
                let own = match place.counts && found.length_mm > resolution && !found.begins {
                    true => place.value,
                    false => value,
                };
                // A change that goes over less than it is known where, may go so; and so may a stated one, of which only the
                // block is known.
                let acts = if stated { value } else { own };
                asked[i].get_or_insert_default().push((place.share, value));
                acting[i].get_or_insert_default().push((place.share, acts));
                let off = Wrench(Wrench(own.into()).0 - Wrench(value.into()).0);
                let force_n = off.force().norm();
                if force_n > 0.0 {
                    let most = by_line.entry(path.moves[i].line).or_default();
                    *most = larger(*most, force_n);
                }
            }
        }
        if asked.iter().all(Option::is_none) {
            return None;
        }
        let profile = |changed: Changed| {
            let mut profile = ByMove::new();
            for (i, own) in changed.into_iter().enumerate() {
                match own {
                    Some(own) => profile.push(self.scale.needed(&own)),
                    None => profile.push(cut.of(i).iter().copied()),
                }
            }
            profile
        };
        let too_fast = by_line.into_iter().map(|(line, force_n)| TooFast {
            line,
            force_n,
            off_mm: force_n / self.stiffness,
        });
        findings.too_fast.extend(too_fast);
        Some((profile(asked), profile(acting)))
    }

    /// Vertices of a move with its ends, and whether the tool cuts there.
    fn vertices(&self, cut: &Profile<6>, i: usize) -> Vec<(f64, [f64; 6], bool)> {
        let own = cut.of(i);
        let counts = |value: &[f64; 6]| self.scale.size(value) > 1.0;
        let mut all: Vec<_> = own.iter().map(|(s, v)| (*s, *v, counts(v))).collect();
        let first = own.first().map_or([0.0; 6], |(_, value)| *value);
        let last = own.last().map_or([0.0; 6], |(_, value)| *value);
        if own.first().is_none_or(|(share, _)| *share > 0.0) {
            all.insert(0, (0.0, first, counts(&first)));
        }
        if own.last().is_none_or(|(share, _)| *share < 1.0) {
            all.push((1.0, last, counts(&last)));
        }
        all
    }

    /// Force and moment per mm, by components: a moment changes in the same length as the force.
    fn rate(&self, load: &ProgramLoad) -> [f64; 6] {
        let force = load.largest_step * self.stiffness / 3_f64.sqrt();
        let arm = self.scale.moment / larger(self.scale.force, f64::MIN_POSITIVE);
        let moment = larger(force * arm, f64::MIN_POSITIVE);
        [force, force, force, moment, moment, moment]
    }
}

/// Feed moves that follow each other without a rapid, by their indices; `joined` says whether a run goes on from one move to the
/// next. Moves so short that they have no direction are part of the run that they follow.
fn runs(path: &Path, joined: impl Fn(&Move, &Move) -> bool) -> Vec<Vec<usize>> {
    let mut runs: Vec<Vec<usize>> = Vec::new();
    let mut open = false;
    // The last move of the open run that has a direction.
    let mut before: Option<&Move> = None;
    for (i, motion) in path.moves.iter().enumerate() {
        if !motion.is_known_feed() {
            (open, before) = (false, None);
            continue;
        }
        let short = motion.length_mm() < SHORT_MM;
        let goes_on = short || before.is_none_or(|before| joined(before, motion));
        match runs.last_mut().filter(|_| open && goes_on) {
            Some(run) => run.push(i),
            None => runs.push(vec![i]),
        }
        open = true;
        if !short {
            before = Some(motion);
        }
    }
    runs
}

/// Initial condition of the run that begins with a move, for all moves: after a rapid nothing acts.
fn begins(path: &Path) -> Vec<Begins> {
    let mut all = vec![Begins::Anyhow; path.moves.len()];
    let mut from = 0;
    while from < path.moves.len() {
        let feed = path.moves[from..].iter().take_while(|m| m.is_known_feed());
        let lengths: Vec<f64> = feed.map(Move::length_mm).collect();
        let after_rapid = from > 0 && path.moves[from - 1].kind == MoveKind::Rapid;
        if after_rapid {
            let in_all_mm = lengths.iter().sum();
            let mut before_mm = 0.0;
            for (own, length) in all[from..].iter_mut().zip(&lengths) {
                *own = Begins::WithNothing(SinceRapid {
                    before_mm,
                    in_all_mm,
                });
                before_mm += length;
            }
        }
        from += lengths.len() + 1;
    }
    all
}

/// The places of a run, with the way along it.
fn of_run<const N: usize>(
    path: &Path,
    run: &[usize],
    of_move: impl Fn(usize) -> Vec<(f64, [f64; N], bool)>,
) -> Vec<Place<N>> {
    let mut places = Vec::new();
    let mut start = 0.0;
    for &move_index in run {
        let length = path.moves[move_index].length_mm();
        let own = of_move(move_index).into_iter();
        places.extend(own.map(|(share, value, counts)| Place {
            move_index,
            share,
            at_mm: start + share * length,
            value,
            counts,
        }));
        start += length;
    }
    places
}
