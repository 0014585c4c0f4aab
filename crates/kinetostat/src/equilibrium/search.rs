//! One search of all equilibria: evenly spread starts, what every new equilibrium suggests, deflation of those that are
//! known, curves through what was found; until nothing new came for long. How sure the result is, by Good and Turing.
//!
//! What a start is, how an equilibrium is found from it, when two are one, and along what curves go is the system's: a
//! chain's ([`crate::equilibrium::chain_search`]) or a machine's ([`crate::equilibrium::machine_search`]).

/// An equilibrium that is known, and how many spread starts ended there.
pub(crate) struct Entry<K> {
    pub known: K,
    pub hits: usize,
}

/// A system whose equilibria are searched.
pub(crate) trait Searched {
    /// Start of an iteration.
    type Start;
    /// Result of an iteration.
    type Candidate;
    /// An equilibrium that counts.
    type Known;

    /// Starts that a person would try; the last is tried first.
    fn structured(&mut self) -> Vec<Self::Start>;
    /// Starts that a new equilibrium suggests: its mirror image, along its critical mode.
    fn suggested(&mut self, known: &Self::Known) -> Vec<Self::Start>;
    /// Takes `count` starts of a sequence that fills their space evenly, after the first `from`.
    fn spread(&mut self, from: usize, count: usize) -> Vec<Self::Start>;
    /// Number of spread starts that are made side by side.
    fn side_by_side(&self) -> usize;
    /// Factor on the length of a search while some equilibrium was hit at most once.
    fn patience(&self) -> usize;

    /// An equilibrium from every start whose iteration converges, in the form in which equilibria are compared.
    fn solve(&mut self, starts: &[Self::Start]) -> Vec<SearchOutcome<Self::Candidate>>;
    /// Solves from one start, repelled by known equilibria (deflation).
    fn deflated(
        &mut self,
        start: &Self::Start,
        known: &[Entry<Self::Known>],
    ) -> SearchOutcome<Self::Candidate>;
    /// True if a candidate is an equilibrium that is known.
    fn same(&self, known: &Self::Known, candidate: &Self::Candidate) -> bool;
    /// A candidate was recognised as this one.
    fn recognised(&self, _known: &mut Self::Known, _candidate: &Self::Candidate) {}
    /// True if a candidate that is known stands for it from now on.
    fn prefers(&self, _candidate: &Self::Candidate, _known: &Self::Known) -> bool {
        false
    }
    /// Everything about a new equilibrium; `None` if it does not count.
    fn described(&mut self, candidate: Self::Candidate) -> Option<Self::Known>;

    /// Curves are followed before starts are spread, and through the commanded place as well; not after them.
    fn curves_first(&self) -> bool;
    /// Curves are followed through so many equilibria at most.
    fn most_curves(&self) -> usize;
    /// Equilibria on curves through a known one, or (`None`) through the commanded place.
    fn connected(&mut self, from: Option<&Self::Known>) -> Vec<SearchOutcome<Self::Candidate>>;
}

/// Outcome of an iteration.
pub(crate) enum SearchOutcome<C> {
    /// Equilibrium that counts.
    Equilibrium(C),
    /// Equilibrium outside of the searched region.
    Outside,
    /// Nowhere.
    Nothing,
}

/// Limits of the search.
pub(crate) struct Limits {
    /// Spread starts in a row that found nothing new.
    pub fruitless: usize,
    /// Spread starts.
    pub starts: usize,
    /// Equilibria.
    pub most: usize,
}

/// Extent of the search, and certainty that there are no more equilibria.
pub(crate) struct Coverage {
    pub starts: usize,
    /// Starts that ended at an equilibrium that counts.
    pub hits: usize,
    pub outside: usize,
    /// Starts since the last new equilibrium.
    pub fruitless: usize,
    /// Chance that one more successful start finds something new, and its upper end (95 %).
    pub chance_of_more: (f64, f64),
    /// The search ended because nothing new came.
    pub exhausted: bool,
}

/// Chance that one more successful start finds something new, and its upper end (95 %): by how many
/// equilibria were found at most once in so many successful starts (Good and Turing; the rule of
/// three where there is none).
fn chance_of_more(hits: usize, once: usize) -> (f64, f64) {
    if hits == 0 {
        return (1.0, 1.0);
    }
    #[allow(clippy::cast_precision_loss)]
    let (n, once) = (hits as f64, once as f64);
    let room = match once == 0.0 {
        true => 3.0,
        false => once + 1.96 * once.sqrt() + 2.0,
    };
    ((once / n).min(1.0), (room / n).min(1.0))
}

/// All equilibria that a search finds.
pub(crate) fn search<S: Searched>(
    system: &mut S,
    limits: &Limits,
) -> (Vec<Entry<S::Known>>, Coverage) {
    let mut queue = system.structured();
    let mut search = EquilibriumSearch {
        system,
        known: Vec::new(),
        outside: 0,
        starts: 0,
        fruitless: 0,
    };
    if search.system.curves_first() {
        search.follow(None);
    }
    let (mut suggested, mut followed) = (0, 0);
    while search.known.len() < limits.most {
        while suggested < search.known.len() {
            queue.extend(search.system.suggested(&search.known[suggested].known));
            suggested += 1;
        }
        let curves = followed < search.known.len().min(search.system.most_curves());
        let spread = !search.enough(limits) && search.starts < limits.starts;
        if let Some(start) = queue.pop() {
            search.try_one(&start, false);
        } else if curves && (search.system.curves_first() || !spread) {
            search.follow(Some(followed));
            followed += 1;
        } else if spread {
            search.spread(limits);
        } else {
            break;
        }
    }
    search.finish(limits)
}

struct EquilibriumSearch<'s, S: Searched> {
    system: &'s mut S,
    known: Vec<Entry<S::Known>>,
    outside: usize,
    starts: usize,
    fruitless: usize,
}

impl<S: Searched> EquilibriumSearch<'_, S> {
    /// True if nothing new was found for long enough; longer while some equilibrium was hit only once.
    fn enough(&self, limits: &Limits) -> bool {
        let rare = self.known.iter().any(|k| k.hits <= 1);
        let patience = if rare { self.system.patience() } else { 1 };
        self.fruitless >= limits.fruitless * patience
    }

    /// Some spread starts.
    fn spread(&mut self, limits: &Limits) {
        let count = (self.system.side_by_side()).min(limits.starts - self.starts);
        let starts = self.system.spread(self.starts, count);
        let ended = self.system.solve(&starts);
        for (start, found) in starts.iter().zip(ended) {
            self.starts += 1;
            self.fruitless += 1;
            self.take(start, found, true);
            if self.enough(limits) {
                break;
            }
        }
    }

    fn try_one(&mut self, start: &S::Start, counted: bool) {
        for found in self.system.solve(std::slice::from_ref(start)) {
            self.take(start, found, counted);
        }
    }

    /// Books what a start found; once more with deflation where it is known.
    fn take(&mut self, start: &S::Start, found: SearchOutcome<S::Candidate>, counted: bool) {
        if self.note(found, counted) {
            let other = self.system.deflated(start, &self.known);
            self.note(other, false);
        }
    }

    fn follow(&mut self, from: Option<usize>) {
        let known = from.map(|i| &self.known[i].known);
        for found in self.system.connected(known) {
            self.note(found, false);
        }
    }

    /// Books an equilibrium; true if it was known.
    fn note(&mut self, found: SearchOutcome<S::Candidate>, counted: bool) -> bool {
        let candidate = match found {
            SearchOutcome::Equilibrium(candidate) => candidate,
            SearchOutcome::Outside => {
                self.outside += usize::from(counted);
                return false;
            }
            SearchOutcome::Nothing => return false,
        };
        for entry in &mut self.known {
            if self.system.same(&entry.known, &candidate) {
                entry.hits += usize::from(counted);
                self.system.recognised(&mut entry.known, &candidate);
                if self.system.prefers(&candidate, &entry.known)
                    && let Some(known) = self.system.described(candidate)
                {
                    entry.known = known;
                }
                return true;
            }
        }
        match self.system.described(candidate) {
            Some(known) => {
                let hits = usize::from(counted);
                self.known.push(Entry { known, hits });
                self.fruitless = 0;
            }
            None => self.outside += usize::from(counted),
        }
        false
    }

    fn finish(self, limits: &Limits) -> (Vec<Entry<S::Known>>, Coverage) {
        let hits: usize = self.known.iter().map(|k| k.hits).sum();
        let once = self.known.iter().filter(|k| k.hits <= 1).count();
        let coverage = Coverage {
            starts: self.starts,
            hits,
            outside: self.outside,
            fruitless: self.fruitless,
            chance_of_more: chance_of_more(hits, once),
            exhausted: self.fruitless >= limits.fruitless && self.known.len() < limits.most,
        };
        (self.known, coverage)
    }
}
