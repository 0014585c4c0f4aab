//! State of a KRL run beside its data: modal state, and the frames that the caller states.

use std::collections::BTreeMap;

use nalgebra::Isometry3;

use crate::interpreter::run;
use crate::interpreter::symbols::Symbols;
use crate::interpreter::token::TokenFile;
use crate::interpreter::tree::Statement;
use crate::interpreter::value::Datum;
use crate::krl::role::Role;
use crate::model::frame::FrameUse;
use crate::model::motion::Speed;
use crate::options::ReadOptions;
use crate::text::name::Name;

/// A run of a KRL program.
pub(crate) type Run<'r, 'p> = run::Run<'r, 'p, Krl>;

/// The numbers of tool and base that a FDAT states.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PointData {
    pub tool: Option<u32>,
    pub base: Option<u32>,
    /// True where the tool stands still and the part is in the hand.
    pub is_external: bool,
}

/// Modal state of motions; unset values are `None`.
#[derive(Debug, Clone, Default)]
pub(crate) struct InForce {
    pub base: Option<FrameUse>,
    pub tool: Option<FrameUse>,
    pub speed: Option<Speed>,
    /// `$APO.CDIS`, mm.
    pub distance_mm: Option<f64>,
    /// `$APO.CPTP`.
    pub joint_percent: Option<f64>,
    /// `$APO.CVEL`.
    pub speed_percent: Option<f64>,
    /// `FDAT_ACT`.
    pub point: Option<PointData>,
    /// The distance of `LDAT_ACT`.
    pub linear_mm: Option<f64>,
    /// The distance of `PDAT_ACT`.
    pub joint: Option<f64>,
    /// `$ORI_TYPE=#CONSTANT`.
    pub keeps_orientation: bool,
}

impl InForce {
    /// Takes back what BAS sets in a way that is not known here.
    pub(crate) fn forget(&mut self) {
        *self = Self {
            point: self.point,
            linear_mm: self.linear_mm,
            joint: self.joint,
            keeps_orientation: self.keeps_orientation,
            ..Self::default()
        };
    }
}

/// State of a KRL run.
pub(crate) struct Krl {
    /// Frames that the caller states, by their names without blanks, in capitals.
    pub stated: BTreeMap<String, Isometry3<f64>>,
    /// Number of assignments to each name.
    pub assigned: BTreeMap<Name, usize>,
    /// Values of elements of the arrays of frames: with which the files begin, and at their first use.
    pub initial: BTreeMap<(Role, u32), Datum>,
    pub used: BTreeMap<(Role, u32), Datum>,
    pub force: InForce,
    /// Modal state before the open spline block.
    pub spline: Option<InForce>,
    /// Reason why the next motion cannot be divided: a statement before it acts somewhere along it.
    pub along_next: Option<&'static str>,
    /// True for each motion whose end has a B beyond 90 degrees, with which the angles of an orientation are ambiguous.
    pub beyond: Vec<bool>,
    /// Opening line of the surrounding fold, by file and line; computed on demand.
    pub folds: Vec<Option<Vec<Option<usize>>>>,
}

impl Krl {
    /// A run that has not begun.
    pub(crate) fn run<'r, 'p>(
        files: &'p [TokenFile<'p>],
        symbols: &'r Symbols<'p>,
        options: &'r ReadOptions,
    ) -> Run<'r, 'p> {
        let stated = options.frames.iter();
        let own = Self {
            stated: stated.map(|(name, frame)| (key(name), *frame)).collect(),
            assigned: assigned(files, symbols),
            initial: BTreeMap::new(),
            used: BTreeMap::new(),
            force: InForce::default(),
            spline: None,
            along_next: None,
            beyond: Vec::new(),
            folds: files.iter().map(|_| None).collect(),
        };
        Run::new(files, symbols, options, own)
    }
}

/// A name as the caller may write it: without blanks, in capitals.
pub(crate) fn key(name: &str) -> String {
    let letters = name.chars().filter(|letter| !letter.is_whitespace());
    letters.collect::<String>().to_uppercase()
}

fn assigned(files: &[TokenFile<'_>], symbols: &Symbols<'_>) -> BTreeMap<Name, usize> {
    let mut found = BTreeMap::new();
    for home in &symbols.routines {
        for statement in &home.routine.body {
            statement.each(&mut |inner| {
                if let Statement::Assignment { tokens, .. } = inner
                    && let Some(name) = files[home.file].name(tokens.start)
                {
                    *found.entry(name).or_default() += 1;
                }
            });
        }
    }
    found
}
