//! A quantity along the path: lists by move, values between places, and how fast they may change.
//!
//! Knows moves and shares of their length; takes values at places; knows neither forces nor machines.

use crate::number::{larger, smaller};

/// Lists, one for each move, in one piece of memory.
#[derive(Clone, Debug)]
pub(crate) struct ByMove<T> {
    all: Vec<T>,
    /// Start of the list of each move; one more than there are moves.
    first: Vec<usize>,
}

/// Values at shares of moves, linear between them.
pub(crate) type Profile<const N: usize> = ByMove<(f64, [f64; N])>;

impl<T> ByMove<T> {
    pub fn new() -> Self {
        Self {
            all: Vec::new(),
            first: vec![0],
        }
    }

    /// The list of the next move.
    pub fn push(&mut self, list: impl IntoIterator<Item = T>) {
        self.all.extend(list);
        self.first.push(self.all.len());
    }

    pub fn of(&self, move_index: usize) -> &[T] {
        match self.first.get(move_index..move_index + 2) {
            Some(&[from, to]) => &self.all[from..to],
            _ => &[],
        }
    }
}

impl<const N: usize> Profile<N> {
    /// The value at a share of a move; `None` where nothing is known of the move.
    pub fn at(&self, move_index: usize, share: f64) -> Option<[f64; N]> {
        let vertices = self.of(move_index);
        let after = vertices.partition_point(|(at, _)| *at < share);
        let before = after.checked_sub(1).and_then(|i| vertices.get(i));
        match (before, vertices.get(after)) {
            (None, None) => None,
            (Some((_, value)), None) | (None, Some((_, value))) => Some(*value),
            (Some((from, a)), Some((to, b))) => {
                let part = match to > from {
                    true => (share - from) / (to - from),
                    false => 1.0,
                };
                Some(between(a, b, part))
            }
        }
    }

    /// Shares inside a move at which the value has another slope.
    pub fn breaks(&self, move_index: usize) -> impl Iterator<Item = f64> + '_ {
        let shares = self.of(move_index).iter().map(|(at, _)| *at);
        shares.filter(|at| *at > 0.0 && *at < 1.0)
    }
}

/// Linear interpolation between two values.
pub(crate) fn between<const N: usize>(from: &[f64; N], to: &[f64; N], part: f64) -> [f64; N] {
    std::array::from_fn(|k| from[k] + part * (to[k] - from[k]))
}

/// The vertices that are needed (Ramer, Douglas and Peucker): of the others, what lies between the needed ones differs by less
/// than what counts. `size` of a difference is 1 where it begins to count.
pub(crate) fn reduced<const N: usize>(
    vertices: &[(f64, [f64; N])],
    size: impl Fn(&[f64; N]) -> f64,
) -> Vec<(f64, [f64; N])> {
    let Some(first) = vertices.first() else {
        return Vec::new();
    };
    let mut needed = vec![*first];
    // Spans that are still to be looked at, the first on top.
    let mut open = vec![(0, vertices.len() - 1)];
    while let Some((from, to)) = open.pop() {
        let (a, b) = (&vertices[from], &vertices[to]);
        let mut worst = (1.0, 0);
        for i in from + 1..to {
            let (at, value) = &vertices[i];
            let part = match b.0 > a.0 {
                true => (at - a.0) / (b.0 - a.0),
                false => 0.0,
            };
            let line = between(&a.1, &b.1, part);
            let off = size(&std::array::from_fn(|k| value[k] - line[k]));
            if off > worst.0 {
                worst = (off, i);
            }
        }
        match worst.1 {
            0 if to > from => needed.push(*b),
            0 => {}
            middle => open.extend([(middle, to), (from, middle)]),
        }
    }
    needed
}

/// A value at a place of the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place<const N: usize> {
    pub move_index: usize,
    /// Share of the move.
    pub share: f64,
    /// Way along the path, mm; grows from place to place.
    pub at_mm: f64,
    pub value: [f64; N],
    /// True if the value counts, false if it is arbitrary.
    pub counts: bool,
}

/// Initial condition of a profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Begins {
    /// Begins with any value.
    Anyhow,
    /// Begins with zero, whatever is requested: the tool comes out of a rapid.
    WithNothing(SinceRapid),
}

/// Start of a profile on the feed path between two rapids.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SinceRapid {
    /// Length at feed from the rapid to the first place, mm.
    pub before_mm: f64,
    /// Length at feed from the rapid to the next one, mm.
    pub in_all_mm: f64,
}

/// A place with the value that the profile has there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limited<const N: usize> {
    pub place: Place<N>,
    pub value: [f64; N],
    /// Length over which the change would go that is too fast here, mm; 0 where none is.
    pub length_mm: f64,
    /// The value is smaller because the profile begins with nothing.
    pub begins: bool,
}

/// Places with values that change by at most `rate` per mm, component by component; `None` where the places themselves do.
///
/// A value that counts (the tool cuts there) is kept wherever the values around it can be reached at the rate that is allowed:
/// the change goes into the air before and after, where it does not matter what the value is. If two values that count are too
/// close to each other, the profile goes midway between the highest and the lowest that they ask for.
///
/// Bounds from below and above are cones of that rate from every place that counts, found in one pass forwards and one
/// backwards. Between two places the bounds are straight lines, so that the places where the profile bends are their
/// intersections.
pub(crate) fn limited<const N: usize>(
    places: &[Place<N>],
    rate: &[f64; N],
    begins: Begins,
) -> Option<Vec<Limited<N>>> {
    if rate.iter().all(|rate| rate.is_infinite()) {
        return None;
    }
    let bounds = Bounds::new(places, rate, begins);
    if !bounds.are_felt(places) {
        return None;
    }
    let mut all = Vec::with_capacity(2 * places.len());
    for (i, place) in places.iter().enumerate() {
        if let Some(before) = i.checked_sub(1) {
            let pair = [&places[before], place];
            for at_mm in bounds.bends(before, pair) {
                let part = (at_mm - pair[0].at_mm) / (place.at_mm - pair[0].at_mm);
                let inside = Place {
                    move_index: place.move_index,
                    share: pair[0].share + part * (place.share - pair[0].share),
                    at_mm,
                    value: between(&pair[0].value, &place.value, part),
                    counts: pair[0].counts && place.counts,
                };
                all.push(bounds.at(inside, [before, i]));
            }
        }
        all.push(bounds.at(*place, [i, i]));
    }
    spread_lengths(&mut all);
    Some(all)
}

/// A change is as long everywhere as where it is longest.
fn spread_lengths<const N: usize>(all: &mut [Limited<N>]) {
    for felt in all.chunk_by_mut(|a, b| (a.length_mm > 0.0) == (b.length_mm > 0.0)) {
        let longest = felt.iter().map(|p| p.length_mm).fold(0.0, larger);
        felt.iter_mut().for_each(|p| p.length_mm = longest);
    }
}

/// Bounds at the places, and how they go between them.
struct Bounds<'a, const N: usize> {
    rate: &'a [f64; N],
    at_mm: Vec<f64>,
    low: Vec<[f64; N]>,
    high: Vec<[f64; N]>,
    /// Rate at the start, from nothing; `None` where it may begin anyhow.
    from_nothing: Option<([f64; N], SinceRapid)>,
}

impl<'a, const N: usize> Bounds<'a, N> {
    fn new(places: &[Place<N>], rate: &'a [f64; N], begins: Begins) -> Self {
        let bound = |none: f64| {
            let of = |p: &Place<N>| if p.counts { p.value } else { [none; N] };
            places.iter().map(of).collect::<Vec<_>>()
        };
        let (mut low, mut high) = (bound(f64::NEG_INFINITY), bound(f64::INFINITY));
        let mut pass = |from: usize, to: usize| {
            let way = (places[to].at_mm - places[from].at_mm).abs();
            for k in 0..N {
                low[to][k] = larger(low[to][k], low[from][k] - rise(rate[k], way));
                high[to][k] = smaller(high[to][k], high[from][k] + rise(rate[k], way));
            }
        };
        (1..places.len()).for_each(|i| pass(i - 1, i));
        (1..places.len()).rev().for_each(|i| pass(i, i - 1));
        Self {
            rate,
            at_mm: places.iter().map(|p| p.at_mm).collect(),
            low,
            high,
            from_nothing: match begins {
                Begins::WithNothing(since) => Some((at_the_start(places, rate, since), since)),
                Begins::Anyhow => None,
            },
        }
    }

    /// True if a place has another value than its own, or a change between two is too fast.
    fn are_felt(&self, places: &[Place<N>]) -> bool {
        let other = |(i, p): (usize, &Place<N>)| self.at(*p, [i, i]).value != p.value;
        let fast = |pair: &[Place<N>]| {
            let way = pair[1].at_mm - pair[0].at_mm;
            (0..N).any(|k| (pair[1].value[k] - pair[0].value[k]).abs() > rise(self.rate[k], way))
        };
        places.iter().enumerate().any(other) || places.windows(2).any(fast)
    }

    /// The value at a place between two (or at one) of those that the bounds were made of.
    fn at(&self, place: Place<N>, [from, to]: [usize; 2]) -> Limited<N> {
        let [before, after] = [place.at_mm - self.at_mm[from], self.at_mm[to] - place.at_mm];
        let mut limited = Limited {
            place,
            value: place.value,
            length_mm: 0.0,
            begins: false,
        };
        for k in 0..N {
            let r = self.rate[k];
            let mut low = larger(
                self.low[from][k] - rise(r, before),
                self.low[to][k] - rise(r, after),
            );
            let mut high = smaller(
                self.high[from][k] + rise(r, before),
                self.high[to][k] + rise(r, after),
            );
            if place.counts {
                low = larger(low, place.value[k]);
                high = smaller(high, place.value[k]);
            }
            let mut value = match low > high {
                true => 0.5 * (low + high),
                false => smaller(larger(place.value[k], low), high),
            };
            if low > high {
                limited.length_mm = larger(limited.length_mm, (low - high) / r);
            }
            if let Some((steepest, since)) = self.from_nothing {
                let most = rise(steepest[k], since.before_mm + place.at_mm - self.at_mm[0]);
                if value.abs() > most {
                    value = most.copysign(value);
                    limited.begins = true;
                }
            }
            limited.value[k] = value;
        }
        limited
    }

    /// Ways at which the profile bends between two places, in order.
    fn bends(&self, from: usize, [a, b]: [&Place<N>; 2]) -> Vec<f64> {
        let way = b.at_mm - a.at_mm;
        let mut parts: Vec<f64> = Vec::new();
        for k in 0..N {
            let r = self.rate[k];
            // Straight lines over the way from the first place: value there, and slope.
            let begun = self.from_nothing.map(|(steepest, since)| {
                let way = since.before_mm + a.at_mm - self.at_mm[0];
                (rise(steepest[k], way), steepest[k])
            });
            // NaN intersects none of the lines.
            let (begun, steepest) = begun.unwrap_or((f64::NAN, f64::NAN));
            let lines = [
                (self.low[from][k], -r),
                (self.low[from + 1][k] - rise(r, way), r),
                (self.high[from][k], r),
                (self.high[from + 1][k] + rise(r, way), -r),
                (a.value[k], (b.value[k] - a.value[k]) / way),
                (begun, steepest),
                (-begun, -steepest),
            ];
            for (i, (value, slope)) in lines.iter().enumerate() {
                for (other, other_slope) in &lines[i + 1..] {
                    let at = (other - value) / (slope - other_slope);
                    if at > 1e-9 * way && at < (1.0 - 1e-9) * way {
                        parts.push(a.at_mm + at);
                    }
                }
            }
        }
        parts.sort_by(f64::total_cmp);
        parts.dedup_by(|b, a| *b - *a < 1e-9 * way);
        parts
    }
}

/// Maximum change of a value over a way; zero over a way of zero, even at an infinite rate.
fn rise(rate: f64, way_mm: f64) -> f64 {
    match way_mm > 0.0 {
        true => rate * way_mm,
        false => 0.0,
    }
}

/// The rate at the start: at least so large that every value is reached before the next rapid.
fn at_the_start<const N: usize>(
    places: &[Place<N>],
    rate: &[f64; N],
    since: SinceRapid,
) -> [f64; N] {
    let sizes = largest(places);
    std::array::from_fn(|k| match sizes[k] > 0.0 && since.in_all_mm > 0.0 {
        true => larger(rate[k], sizes[k] / since.in_all_mm),
        false => rate[k],
    })
}

/// Length over which the largest value comes from nothing, mm.
pub(crate) fn comes_over_mm<const N: usize>(places: &[Place<N>], rate: &[f64; N]) -> f64 {
    let sizes = largest(places);
    let ways = (0..N)
        .filter(|k| sizes[*k] > 0.0)
        .map(|k| sizes[k] / rate[k]);
    ways.fold(0.0, larger)
}

/// Largest size of each component.
fn largest<const N: usize>(places: &[Place<N>]) -> [f64; N] {
    std::array::from_fn(|k| places.iter().map(|p| p.value[k].abs()).fold(0.0, larger))
}
