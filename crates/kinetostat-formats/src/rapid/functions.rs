//! Functions of the controller: those that are computed here, and those that leave their arguments as they are.
//!
//! Source: ABB, Technical reference manual, RAPID Instructions, Functions and Data types (3HAC050917). Others, as `StrToVal` and
//! functions of modules that are not given, may have parameters (INOUT) by which they change it.

use std::ops::Range;

use nalgebra::{UnitQuaternion, Vector3};

use crate::interpreter::expression::{Argument, Node};
use crate::interpreter::operation::function;
use crate::interpreter::token::TokenFile;
use crate::interpreter::value::{Datum, Step, Value};
use crate::model::motion::FrameUse;
use crate::rapid::literals::{frame_of, list_of_frame, orient_of, rotation_of};
use crate::rapid::state::Run;
use crate::text::Name;

/// In the order of their bytes; operators that stand before a bracket with them.
#[rustfmt::skip]
const LEAVE: [&str; 135] = [
    "ABS", "ABSDNUM", "ACOS", "ACOSDNUM", "AINPUT", "AND", "AOUTPUT", "ARGNAME", "ASIN", "ASINDNUM", "ATAN",
    "ATAN2", "ATAN2DNUM", "ATANDNUM", "BITAND", "BITCHECK", "BITLSH", "BITNEG", "BITOR", "BITRSH", "BITXOR",
    "BYTETOSTR", "CALCJOINTT", "CALCROBT", "CALCROTAXFRAMEZ", "CALCROTAXISFRAME", "CDATE", "CJOINTT",
    "CLKREAD", "COS", "COSDNUM", "CPOS", "CROBT", "CROSSPROD", "CSPEEDOVERRIDE", "CTIME", "CTOOL", "CWOBJ",
    "DEFACCFRAME", "DEFDFRAME", "DEFFRAME", "DIM", "DINPUT", "DISTANCE", "DIV", "DNUMTONUM", "DNUMTOSTR",
    "DOTPROD", "DOUTPUT", "EULERZYX", "EXP", "FILESIZE", "GETSYSINFO", "GETTASKNAME", "GETTIME", "GINPUT",
    "GINPUTDNUM", "GOUTPUT", "GOUTPUTDNUM", "ISFILE", "ISMECHUNITACTIVE", "ISPERS", "ISSTOPMOVEACT",
    "ISSYNCMOVEON", "ISVAR", "MAX", "MAXROBSPEED", "MIN", "MIRPOS", "MOD", "NORIENT", "NOT", "NUMTODNUM",
    "NUMTOSTR", "OFFS", "OPMODE", "OR", "ORIENTZYX", "OROBT", "PARIDPOSVALID", "PARIDROBVALID", "PATHLEVEL",
    "PATHRECVALIDBWD", "PATHRECVALIDFWD", "POSEINV", "POSEMULT", "POSEVECT", "POW", "POWDNUM", "PRESENT",
    "READBIN", "READNUM", "READSTR", "READSTRBIN", "RELTOOL", "ROBNAME", "ROBOS", "ROUND", "ROUNDDNUM",
    "RUNMODE", "SIN", "SINDNUM", "SQRT", "SQRTDNUM", "STRFIND", "STRLEN", "STRMAP", "STRMATCH", "STRMEMB",
    "STRORDER", "STRPART", "STRTOBYTE", "TAN", "TANDNUM", "TASKRUNMEC", "TASKRUNROB", "TASKSINSYNC", "TESTDI",
    "TEXTGET", "TEXTTABGET", "TRIGGDATAVALID", "TRUNC", "TRUNCDNUM", "TYPE", "UIALPHAENTRY", "UIDNUMENTRY",
    "UILISTVIEW", "UIMESSAGEBOX", "UIMSGBOX", "UINUMENTRY", "UINUMTUNE", "VALIDIO", "VALTOSTR", "VECTMAGN",
    "XOR",
];

/// Instructions that are carried and change the numbers that they are given.
pub(super) const CHANGE_THEIRS: [&str; 4] = ["Add", "Clear", "Decr", "Incr"];

/// True if a function that is in none of the files is known not to change its arguments.
pub(super) fn leaves_arguments(name: &Name) -> bool {
    let found = LEAVE.binary_search_by(|known| known.as_bytes().cmp(name.letters()));
    found.is_ok()
}

/// The arguments of a function, evaluated.
pub(super) struct Given {
    pub ordered: Vec<Datum>,
    pub options: Vec<(Name, Datum)>,
}

impl Given {
    fn option(&self, capitals: &str) -> Option<&Datum> {
        let found = self.options.iter().find(|(name, _)| name.is(capitals));
        found.map(|(_, value)| value)
    }

    fn number(&self, at: usize) -> Option<f64> {
        self.ordered.get(at)?.as_number()
    }

    fn place(&self, at: usize) -> Option<Vector3<f64>> {
        self.ordered.get(at)?.as_numbers::<3>().map(Vector3::from)
    }

    /// The first part that only the controller knows.
    fn unknown(&self) -> Option<Datum> {
        let all = self.ordered.iter();
        let all = all.chain(self.options.iter().map(|(_, value)| value));
        let reason = all.into_iter().find_map(Datum::unknown_reason)?;
        Some(Datum::unknown(reason.clone()))
    }
}

/// The result of a function of the controller; none where it is not computed here.
pub(super) fn computed(name: &Name, given: &Given) -> Option<Datum> {
    let name = std::str::from_utf8(name.letters()).ok()?;
    let of_one: Option<fn(f64) -> f64> = match name {
        "ABS" | "SQRT" | "SIN" | "COS" | "TAN" | "ASIN" | "ACOS" | "EXP" => function(name),
        "ABSDNUM" | "SQRTDNUM" | "SINDNUM" | "COSDNUM" | "TANDNUM" | "ASINDNUM" | "ACOSDNUM" => {
            function(name.trim_end_matches("DNUM"))
        }
        "ATAN" | "ATANDNUM" => Some(|value| value.atan().to_degrees()),
        "NUMTODNUM" | "DNUMTONUM" => Some(|value| value),
        _ => None,
    };
    let is_known = of_one.is_some()
        || matches!(
            name,
            "ATAN2"
                | "ATAN2DNUM"
                | "POW"
                | "POWDNUM"
                | "ROUND"
                | "ROUNDDNUM"
                | "TRUNC"
                | "TRUNCDNUM"
                | "MAX"
                | "MIN"
                | "DISTANCE"
                | "VECTMAGN"
                | "DOTPROD"
                | "CROSSPROD"
                | "ORIENTZYX"
                | "EULERZYX"
                | "POSEMULT"
                | "POSEINV"
                | "POSEVECT"
                | "NORIENT"
                | "DIM"
                | "OFFS"
                | "RELTOOL"
        );
    if !is_known {
        return None;
    }
    if let Some(unknown) = given.unknown() {
        return Some(unknown);
    }
    let found = match of_one {
        Some(of_one) => given
            .number(0)
            .map(of_one)
            .filter(|value| value.is_finite())
            .map(Datum::number),
        None => of_several(name, given),
    };
    Some(found.unwrap_or_else(|| match name {
        "OFFS" | "RELTOOL" => Datum::unknown("an offset has a target and three lengths"),
        _ => Datum::unknown(format!("the arguments of {name} are not of its kind")),
    }))
}

fn of_several(name: &str, given: &Given) -> Option<Datum> {
    let frame = |at: usize| frame_of(given.ordered.get(at)?);
    let list = |place: Vector3<f64>| Datum::numbers(place.iter().copied());
    Some(match name {
        "ATAN2" | "ATAN2DNUM" => {
            Datum::number(given.number(0)?.atan2(given.number(1)?).to_degrees())
        }
        "POW" | "POWDNUM" => Datum::number(given.number(0)?.powf(given.number(1)?)),
        "MAX" => Datum::number(larger(given.number(0)?, given.number(1)?)),
        "MIN" => Datum::number(-larger(-given.number(0)?, -given.number(1)?)),
        "ROUND" | "ROUNDDNUM" | "TRUNC" | "TRUNCDNUM" => {
            let decimals = given.option("DEC").map_or(Some(0.0), Datum::as_number)?;
            let unit = 10f64.powi(decimals.clamp(0.0, 15.0) as i32);
            let scaled = unit * given.number(0)?;
            let whole = match name.starts_with("ROUND") {
                true => scaled.round(),
                false => scaled.trunc(),
            };
            Datum::number(whole / unit)
        }
        "DISTANCE" => Datum::number((given.place(0)? - given.place(1)?).norm()),
        "VECTMAGN" => Datum::number(given.place(0)?.norm()),
        "DOTPROD" => Datum::number(given.place(0)?.dot(&given.place(1)?)),
        "CROSSPROD" => list(given.place(0)?.cross(&given.place(1)?)),
        "ORIENTZYX" => {
            let [z, y, x] = [0, 1, 2].map(|at| given.number(at).map(f64::to_radians));
            orient_of(&turned([z?, y?, x?]))
        }
        "EULERZYX" => {
            let (x, y, z) = rotation_of(given.ordered.first()?)?.euler_angles();
            let chosen = [("X", x), ("Y", y), ("Z", z)];
            let (_, angle) = chosen
                .into_iter()
                .find(|(axis, _)| given.option(axis).is_some())?;
            Datum::number(angle.to_degrees())
        }
        "POSEMULT" => list_of_frame(&(frame(0)? * frame(1)?)),
        "POSEINV" => list_of_frame(&frame(0)?.inverse()),
        "POSEVECT" => list((frame(0)? * nalgebra::Point3::from(given.place(1)?)).coords),
        "NORIENT" => {
            let [w, i, j, k] = given.ordered.first()?.as_numbers::<4>()?;
            let turn = nalgebra::Quaternion::new(w, i, j, k);
            orient_of(&UnitQuaternion::try_new(turn, 1e-6)?)
        }
        "DIM" => Datum::number(given.ordered.first()?.parts().len() as f64),
        "OFFS" | "RELTOOL" => offset(name, given)?,
        _ => return None,
    })
}

/// A turn about z, then about the new y, then about the new x.
fn turned([z, y, x]: [f64; 3]) -> UnitQuaternion<f64> {
    let about = |axis, angle| UnitQuaternion::from_axis_angle(&axis, angle);
    about(Vector3::z_axis(), z) * about(Vector3::y_axis(), y) * about(Vector3::x_axis(), x)
}

/// `Offs(p,x,y,z)` in the axes of the work object, `RelTool(p,x,y,z\Rx\Ry\Rz)` in those of the tool: about x, then the new y, then the
/// new z.
fn offset(name: &str, given: &Given) -> Option<Datum> {
    let target = given.ordered.first()?;
    let [place, turn, ..] = target.parts() else {
        return None;
    };
    let place = place.as_numbers::<3>().map(Vector3::from)?;
    let [x, y, z] = [1, 2, 3].map(|at| given.number(at));
    let by = Vector3::new(x?, y?, z?);
    let mut found = target.clone();
    let (place, turned) = match name {
        "OFFS" => (place + by, None),
        _ => {
            let rotation = rotation_of(turn)?;
            let angle = |axis: &str| {
                let stated = given.option(axis).map_or(Some(0.0), Datum::as_number)?;
                Some(stated.to_radians())
            };
            let about = |axis, angle| UnitQuaternion::from_axis_angle(&axis, angle);
            let turn = about(Vector3::x_axis(), angle("RX")?)
                * about(Vector3::y_axis(), angle("RY")?)
                * about(Vector3::z_axis(), angle("RZ")?);
            (place + rotation * by, Some(rotation * turn))
        }
    };
    found.put(&[Step::Index(0)], Datum::numbers(place.iter().copied()));
    if let Some(rotation) = turned {
        found.put(&[Step::Index(1)], orient_of(&rotation));
    }
    Some(Datum::of(Value::clone(&found.value)))
}

fn larger(one: f64, other: f64) -> f64 {
    match one >= other {
        true => one,
        false => other,
    }
}

impl Run<'_, '_> {
    /// `DInput(di1)` and its kin, with the value that the caller states for the signal.
    pub(super) fn stated_signal(&mut self, name: &Name, arguments: &[Argument]) -> Option<Datum> {
        let reads = [
            "DINPUT", "DOUTPUT", "GINPUT", "GOUTPUT", "AINPUT", "AOUTPUT", "TESTDI",
        ];
        let [
            Argument {
                value: Some(signal),
                ..
            },
        ] = arguments
        else {
            return None;
        };
        let (true, Node::Word(signal)) = (reads.iter().any(|read| name.is(read)), &signal.node)
        else {
            return None;
        };
        let value = self.values.ask(signal)?;
        Some(match (name.is("TESTDI"), value.as_number()) {
            (true, Some(number)) => Datum::truth(number != 0.0),
            _ => value,
        })
    }

    /// `CRobT`: the end of the last motion, with the same tool and work object.
    pub(super) fn current_target(&self, arguments: &[Argument]) -> Option<Datum> {
        let last = self.motions.get(self.here?)?;
        let pose = last.target.pose()?;
        let is_that_of = |name: &str, frame: &FrameUse| {
            let option = |argument: &&Argument| argument.option.is_some_and(|own| own.is(name));
            let given = arguments.iter().find(option)?;
            let text = self.text(given.value.as_ref()?);
            Some(text.eq_ignore_ascii_case(&frame.name))
        };
        let is_same = is_that_of("TOOL", &last.tool).unwrap_or(true)
            && is_that_of("WOBJ", &last.work_object).unwrap_or(true);
        let external = (0..6).map(|axis| pose.external.get(axis).copied().flatten().unwrap_or(9e9));
        is_same.then(|| {
            Datum::list(vec![
                Datum::numbers(pose.position_mm.iter().copied()),
                orient_of(&pose.orientation),
                Datum::numbers(pose.configuration.numbers.iter().copied()),
                Datum::numbers(external),
            ])
        })
    }

    /// The arguments of a function of the controller.
    pub(super) fn given(&mut self, arguments: &[Argument]) -> Given {
        let mut given = Given {
            ordered: Vec::with_capacity(4),
            options: Vec::new(),
        };
        for Argument { option, value } in arguments {
            let value = value.as_ref().map(|value| self.value(value));
            match (option, value) {
                (Some(name), value) => {
                    given
                        .options
                        .push((*name, value.unwrap_or(Datum::truth(true))));
                }
                (None, Some(value)) => given.ordered.push(value),
                (None, None) => {}
            }
        }
        given
    }
}

/// True if the run computes which routine is called: `%"name"%`, `CallByVar`.
pub(super) fn is_computed(file: &TokenFile<'_>, tokens: &Range<usize>) -> bool {
    let word = file.word(tokens.start);
    word == b"%" || word.eq_ignore_ascii_case(b"CallByVar")
}
