//! Corrections of a program from measured points: the mirror technique, trial by trial.
//!
//! A machine leaves its path by deviations that no model knows in full. They are measured on the part or at the tool
//! ([`MeasuredPoints`]), brought into the frame of the program ([`register`]), given to places of the path ([`Alignment`]), freed
//! of outliers, smoothed along the path ([`Kernel`]) and added to the program with the opposite sign ([`MirrorState`]); the
//! next trial is measured again. What the points do not tell is said ([`Unseen`], [`FreeMotion`]); for which
//! relaxation the error cannot rise, and by which factor it falls, is proven ([`Convergence`]); the iteration ends where what is left
//! is within the repeatability ([`floor_mm`]). [`MirrorField`] is the correction for the writer of programs, and
//! [`SumOfFields`] adds it to the compensation by a model.
//!
//! This crate knows no robot. Lengths are in mm, in the frame of the program.
//!
//! ```
//! use kinetostat_mirror::*;
//! use kinetostat_program::*;
//! use nalgebra::Vector3;
//!
//! let program = Program::read("G21 G90\nG0 X0 Y0 Z0\nG1 X100 F300\nM2\n")?;
//! let path = interpret(&program, &ReadOptions::default())?;
//! let nominal = NominalPath::new(&path)?;
//! let settings = MeasureSettings { register: Register::None, ..MeasureSettings::default() };
//! let mut state = MirrorState::new(&nominal, "the program's hash", settings)?;
//!
//! // A machine that goes 0.1 mm too far to the left, measured every mm.
//! let points: Vec<_> = (0..=100).map(|x| Vector3::new(f64::from(x), 0.1, 0.0)).collect();
//! let measured = measure(&nominal, &MeasuredPoints::at(&points)?, &settings)?;
//! let file = MeasuredFile { name: "trial1.csv".into(), sha256: "its hash".into() };
//! let outcome = state.take(&nominal, &[(file, measured)], 1.0, None)?;
//! assert_eq!(outcome, Outcome::GoOn);
//!
//! let field = MirrorField::new(&nominal, &state)?;
//! let written = write_corrected(&program, &path, &field, &WriteOptions::default(), &Unwatched)?;
//! let text = String::from_utf8(written.bytes)?;
//! let corrected = interpret(&Program::read(text)?, &ReadOptions::default())?;
//! let middle = corrected.moves.iter().find(|m| (40.0..60.0).contains(&m.end.x));
//! assert!((middle.unwrap_or(&corrected.moves[0]).end.y + 0.1).abs() < 1e-3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod alignment;
mod deviation;
mod error;
mod number;
mod points;
mod registration;
mod trial;

pub use alignment::{AlignedPoint, Alignment, LeftOut};
pub use deviation::{
    DeviationFigures, Kernel, MeasureSettings, Measurement, OnLines, Outlier, PieceMean, Register,
    Smoothed, Stations, Stretch, Unseen, measure, on_lines,
};
pub use error::MirrorError;
pub use kinetostat_program::{Foot, NominalPath, Pass, WhyLeftOut};
pub use points::{MeasuredPoint, MeasuredPoints};
pub use registration::{FreeMotion, Motion, Registration, RegistrationOptions, ToldBy, register};
pub use trial::{
    Averaging, Convergence, MeasuredFile, MirrorField, MirrorState, Outcome, Repeatability,
    SumOfFields, Trial, bound_on_relaxation, floor_mm,
};
