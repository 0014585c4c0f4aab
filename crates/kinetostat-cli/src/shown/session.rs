//! A session: one machine, perhaps with the program of a job, and the states that are asked of it.

use std::collections::BTreeSet;
use std::path::PathBuf;

use kinetostat::{Mechanism, Posture, PostureRequest, Wrench};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_dynamics::Damping;
use kinetostat_model::Model;
use kinetostat_report::{Placed, Scene};
use kinetostat_view::{Answers, Refused, exported};
use nalgebra::Vector3;
use rayon::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::machine::units::unit;
use crate::place::arguments::PlaceArgs;
use crate::place::joints;
use crate::place::query::place_query_of;
use crate::shown::answer::{
    ActuatorRange, CurveRequest, Exported, ExportedState, LobesRequest, MachineAnswer, MapRequest,
    Nothing, ResponseRequest, StateAnswer, StateRequest, StockAtPlace, StockRequest,
};
use crate::shown::curve::curve_of;
use crate::shown::cutting::{lobes_of, response_of};
use crate::shown::map::{map_of, variables};
use crate::shown::modes::modes_of;
use crate::shown::path::{AtPlace, ShownPath};
use crate::shown::state::state_of;
use crate::ui::failure::{Answer, Failing, Failure};

/// A machine and what belongs to it.
pub(crate) struct Session {
    /// As the command line names it.
    pub(crate) named: String,
    pub(crate) path: Option<PathBuf>,
    /// The model; with a job, its machine has the job's tool.
    pub(crate) model: Model,
    pub(crate) program: Option<ShownPath>,
}

/// Largest force and moment that are asked for, N and N m: what exceeds it is a wrong unit.
const MOST_LOAD: f64 = 1e9;

/// States along the path that an exported page holds.
const EXPORTED_STATES: usize = 60;

impl Session {
    fn mechanism(&self) -> &Mechanism {
        &self.model.mechanism
    }

    pub(crate) fn machine_answer(&self) -> Answer<MachineAnswer> {
        let mechanism = self.mechanism();
        let home = joints::of_model(mechanism, &joints::home(mechanism));
        let actuators = mechanism.limbs().iter().flat_map(|l| l.nominal.actuators());
        let ranges = home.into_iter().zip(actuators).map(|(home, actuator)| {
            let shown = |x: f64| x / unit(actuator.kind).1;
            ActuatorRange {
                name: home.name,
                unit: home.unit,
                low: actuator.limits.map(|(low, _)| shown(low)),
                high: actuator.limits.map(|(_, high)| shown(high)),
                home: home.value,
            }
        });
        let target = mechanism.platforms()[mechanism.tool()].home;
        let posture = mechanism.posture(&target)?;
        let size = Scene::of(mechanism, &Placed::at(&posture)).size();
        Ok(MachineAnswer {
            name: self.model.name().to_owned(),
            description: self.model.document.mechanism.description.clone(),
            source: self.named.clone(),
            actuators: ranges.collect(),
            limbs: mechanism.limbs().iter().map(|l| l.name.clone()).collect(),
            size_mm: 1e3 * size,
            gravity_m_per_s2: mechanism.gravity().into(),
            has_path: self.program.is_some(),
            variables: variables(&posture, &self.model.ratings()),
            is_damped: !matches!(self.model.damping(), Damping::Undamped),
            model_text: self.model.text.clone(),
            version: env!("CARGO_PKG_VERSION"),
        })
    }

    /// The machine in a posture that is asked for, and the load on its tool.
    fn asked(&self, request: &StateRequest) -> Answer<(Posture, Wrench)> {
        let asked = [
            request.actuators.is_some(),
            request.at_mm.is_some(),
            request.place.is_some(),
        ];
        if asked.iter().filter(|given| **given).count() > 1 {
            return Err(ErrorCode::Conflict.failure(
                "a state is asked for by actuators, by at_mm or by place: give one of them",
            ));
        }
        let mechanism = self.mechanism();
        if request.place.is_some() && (request.force_n.is_some() || request.moment_n_m.is_some()) {
            return Err(ErrorCode::Conflict.failure(
                "at a place of the program its own load acts: leave force_n and moment_n_m out",
            ));
        }
        let load = |what: &str, given: Option<[f64; 3]>| {
            let v = given.unwrap_or_default();
            match v.iter().all(|x| x.abs() <= MOST_LOAD) {
                true => Ok(Vector3::from(v)),
                false => Err(ErrorCode::Value.failure(format!(
                    "{what} has to be finite, and at most {MOST_LOAD:e}"
                ))),
            }
        };
        let given = Wrench::new(
            load("force_n", request.force_n)?,
            load("moment_n_m", request.moment_n_m)?,
        );
        Ok(if let Some(at) = request.at_mm {
            let place = PlaceArgs {
                at: Some(at.to_vec()),
                ..PlaceArgs::default()
            };
            let query = place_query_of(
                &self.model,
                self.path.clone(),
                &self.named,
                &place,
                None,
                None,
                None,
            )?;
            (query.standing()?, given)
        } else if let Some(index) = request.place {
            let place = self.place(index)?;
            (place.posture(mechanism)?, place.wrench)
        } else {
            let commands = match &request.actuators {
                Some(values) => commands(mechanism, values)?,
                None => joints::home(mechanism),
            };
            (
                mechanism.posture(PostureRequest::commands(&commands))?,
                given,
            )
        })
    }

    pub(crate) fn state_answer(&self, request: &StateRequest) -> Answer<StateAnswer> {
        let (posture, wrench) = self.asked(request)?;
        let mut answer = state_of(&posture, &wrench, &self.named);
        if self.program.is_some() {
            // The tool of a job has more words than the options of a single place.
            let (_, state) = answer.cli.split_once(" --joints").unwrap_or_default();
            answer.cli = match request.place {
                Some(_) => format!("kinetostat deflect {}", self.named),
                None => format!("kinetostat view {} --joints{state}", self.named),
            };
        }
        Ok(answer)
    }

    fn stock_at(&self, request: &StockRequest) -> Answer<StockAtPlace> {
        let place = self.place(request.place)?;
        let stock = self.program.as_ref().and_then(|own| own.stock.as_ref());
        let stock = stock.ok_or_else(|| ErrorCode::Missing.failure("the job has no stock"))?;
        stock.at(place.on_move)
    }

    /// A place of the program.
    fn place(&self, index: usize) -> Answer<&AtPlace> {
        let program = self.program.as_ref();
        let place = program.and_then(|program| program.places.get(index));
        place.ok_or_else(|| ErrorCode::Value.failure(format!("there is no place {index}")))
    }

    /// Results in a page without a server, at a state: of a path some states, those at its largest errors among them.
    fn exported(&self, request: &StateRequest, live: bool) -> Answer<Exported> {
        let places = self
            .program
            .as_ref()
            .map_or(0, |program| program.places.len());
        let step = places.div_ceil(EXPORTED_STATES).max(1);
        let worst = self.program.iter().flat_map(ShownPath::worst);
        let asked: BTreeSet<usize> = (0..places).step_by(step).chain(worst).collect();
        let at = |place: usize| {
            let request = StateRequest {
                place: Some(place),
                ..StateRequest::default()
            };
            let state = self.state_answer(&request)?;
            Ok(ExportedState { place, state })
        };
        Ok(Exported {
            live,
            machine: self.machine_answer()?,
            state: self.state_answer(request)?,
            path: self.program.as_ref().map(|program| program.answer.clone()),
            states: asked.into_par_iter().map(at).collect::<Answer<_>>()?,
        })
    }

    /// The page with its results, at a state: it needs no server. A live one asks the page around it.
    pub(crate) fn page(&self, request: &StateRequest, live: bool) -> Answer<String> {
        let results = serde_json::to_string(&self.exported(request, live)?);
        let results = results.map_err(|error| ErrorCode::Internal.failure(error.to_string()))?;
        exported(&results)
            .ok_or_else(|| ErrorCode::Internal.failure("the page has no place for results"))
    }
}

/// Commands (m, rad) of values as they are shown.
fn commands(mechanism: &Mechanism, values: &[f64]) -> Answer<Vec<f64>> {
    let kinds = joints::kinds(mechanism);
    if values.len() != kinds.len() || !values.iter().all(|x| x.abs() <= 1e7) {
        return Err(ErrorCode::Value.failure(format!(
            "actuators has {} values; {} finite ones are needed, mm and deg",
            values.len(),
            kinds.len()
        )));
    }
    Ok(values
        .iter()
        .zip(kinds)
        .map(|(x, kind)| x * unit(kind).1)
        .collect())
}

impl From<Failure> for Refused {
    fn from(failure: Failure) -> Self {
        let code = failure.diagnostics().into_iter().next().map(|d| d.code);
        let code = serde_json::to_value(code).unwrap_or_default();
        let code = code.as_str().unwrap_or_default();
        Self::new(code, failure.plain)
    }
}

/// The answer to a request, both as JSON.
pub(crate) fn answered<R: DeserializeOwned, A: Serialize>(
    request: &[u8],
    answer: impl FnOnce(R) -> Answer<A>,
) -> Result<String, Refused> {
    let answer = answer(read(request)?)?;
    serde_json::to_string(&answer).map_err(|error| Refused::new("internal", error.to_string()))
}

pub(crate) fn read<R: DeserializeOwned>(request: &[u8]) -> Result<R, Refused> {
    // Values alone, in the order of the fields, would be taken for an object.
    let read = match request.trim_ascii_start().first() {
        Some(b'{') => serde_json::from_slice(request).map_err(|error| error.to_string()),
        _ => Err("an object is needed".to_owned()),
    };
    read.map_err(|reason| Refused::new("value", format!("the request is not understood: {reason}")))
}

impl Answers for Session {
    fn answer(&self, question: &str, request: &[u8]) -> Option<Result<String, Refused>> {
        Some(match question {
            "machine" => answered(request, |Nothing {}| self.machine_answer()),
            "path" => answered(request, |Nothing {}| {
                Ok(self.program.as_ref().map(|program| &program.answer))
            }),
            "state" => answered(request, |state| self.state_answer(&state)),
            "modes" => answered(request, |state| {
                let (posture, wrench) = self.asked(&state)?;
                modes_of(&posture, &wrench)
            }),
            "curve" => answered(request, |curve: CurveRequest| {
                let (posture, wrench) = self.asked(&curve.state)?;
                curve_of(&posture, &wrench, curve.factor)
            }),
            "stock" => answered(request, |stock: StockRequest| self.stock_at(&stock)),
            "map" => answered(request, |map: MapRequest| {
                let (posture, wrench) = self.asked(&map.state)?;
                map_of(&posture, &wrench, self.model.ratings(), &map)
            }),
            "response" => answered(request, |response: ResponseRequest| {
                let (posture, wrench) = self.asked(&response.state)?;
                response_of(&posture, &wrench, &self.model.damping(), &response)
            }),
            "lobes" => answered(request, |lobes: LobesRequest| {
                let (posture, wrench) = self.asked(&lobes.state)?;
                lobes_of(&posture, &wrench, &self.model.damping(), &lobes)
            }),
            _ => return None,
        })
    }
}
