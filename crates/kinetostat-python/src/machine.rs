//! A machine: read, changed, commanded.

use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use kinetostat::batch::Batch;
use kinetostat::machine::LimbPosture;
use kinetostat::nalgebra::{UnitQuaternion, Vector3};
use kinetostat::{Mechanism, MotionKind, Pose, PostureRequest};
use kinetostat_import::{JointStiffness, UrdfOptions, import_urdf};
use kinetostat_machining::Configurations;
use kinetostat_model::Model;
use numpy::PyArray2;
use pyo3::prelude::*;
use sha2::{Digest, Sha256};

use crate::arrays::{Numbers, array, matrix_of, one_pose, one_wrench};
use crate::equilibrium::Equilibrium;
use crate::errors::{Class, error, of_core, of_model, require_stiffness};
use crate::plausibility::of_figures;
use crate::posture::Posture;
use crate::stiffness::json_of;

/// A model with its tool, and the machine compiled for many postures once one is asked for.
#[pyclass(frozen, module = "kinetostat._core")]
pub struct Machine {
    pub(crate) model: Arc<Model>,
    pub(crate) tool: Pose,
    pub(crate) mechanism: Mechanism,
    compiled: OnceLock<Arc<Batch>>,
    configurations: OnceLock<Arc<Configurations>>,
    turns: OnceLock<bool>,
}

impl Machine {
    fn new(model: Arc<Model>, tool: Pose) -> Self {
        let mechanism = model.mechanism.with_tool(&tool);
        Self {
            model,
            tool,
            mechanism,
            compiled: OnceLock::new(),
            configurations: OnceLock::new(),
            turns: OnceLock::new(),
        }
    }

    fn read(model: Result<Model, kinetostat_model::ModelError>) -> PyResult<Self> {
        let model = model.map_err(|e| of_model(&e))?;
        Ok(Self::new(Arc::new(model), Pose::identity()))
    }

    pub(crate) fn batch(&self) -> Arc<Batch> {
        self.compiled
            .get_or_init(|| Arc::new(Batch::new(&self.mechanism)))
            .clone()
    }

    pub(crate) fn configurations(&self) -> Arc<Configurations> {
        self.configurations
            .get_or_init(|| Arc::new(Configurations::of(&self.mechanism)))
            .clone()
    }

    /// The tool turns as the machine moves.
    pub(crate) fn turns(&self) -> bool {
        *self
            .turns
            .get_or_init(|| self.mechanism.turns_as_it_moves())
    }

    /// Rated forces (N) or torques (N m) of the actuators, as far as they are stated.
    pub(crate) fn ratings(&self) -> Vec<Option<f64>> {
        self.model.ratings()
    }

    fn home(&self) -> Pose {
        self.mechanism.platforms()[self.mechanism.tool()].home
    }
}

fn kind(kind: MotionKind) -> &'static str {
    match kind {
        MotionKind::Prismatic => "prismatic",
        MotionKind::Revolute => "revolute",
    }
}

#[pymethods]
impl Machine {
    /// Equilibrium of a posture of this machine under a wrench (6,) on the tool: force (N), moment (N m), base axes, about its reference
    /// point. Values beyond a limit are issued as a warning of the line that called the Python method.
    fn deflected(&self, posture: &Posture, wrench: &Bound<'_, PyAny>) -> PyResult<Equilibrium> {
        let py = wrench.py();
        let wrench = one_wrench("wrench", wrench)?;
        let mechanism = posture.0.mechanism();
        require_stiffness(mechanism)?;
        let found = py.detach(|| match self.batch().deflected(&posture.0, &wrench) {
            Some(found) => Ok(Equilibrium::by_kernels(&posture.0, wrench, found)),
            None => posture.0.deflected_by(&wrench).map(Equilibrium::of),
        });
        let found = found.map_err(|e| of_core(&e))?;
        let moved = found.moved()?.1.linear().norm();
        let warnings = of_figures(mechanism, &wrench, moved);
        if !warnings.is_empty() {
            let module = py.import("kinetostat._plausibility")?;
            module.call_method1("issue", (warnings,))?;
        }
        Ok(found)
    }

    #[staticmethod]
    fn open(py: Python<'_>, name_or_path: &str) -> PyResult<Self> {
        Self::read(py.detach(|| Model::open(name_or_path)))
    }

    #[staticmethod]
    fn preset(py: Python<'_>, name: &str) -> PyResult<Self> {
        Self::read(py.detach(|| Model::preset(name)))
    }

    #[staticmethod]
    fn from_toml(py: Python<'_>, text: &str, file: &str) -> PyResult<Self> {
        Self::read(py.detach(|| Model::from_toml(text, file)))
    }

    /// Reads a document as JSON: the keys of a model file.
    #[staticmethod]
    fn from_json(py: Python<'_>, json: &str, file: &str) -> PyResult<Self> {
        let document: serde_json::Value =
            serde_json::from_str(json).map_err(|e| error(Class::Model, e.to_string()))?;
        // Read as text, so that mistakes are reported like those of a file.
        let text = toml::to_string(&document).map_err(|e| error(Class::Model, e.to_string()))?;
        Self::read(py.detach(|| Model::from_toml(&text, file)))
    }

    #[getter]
    fn name(&self) -> &str {
        self.model.name()
    }

    #[getter]
    fn file(&self) -> &str {
        &self.model.file
    }

    /// The text of the model file.
    #[getter]
    fn text(&self) -> &str {
        &self.model.text
    }

    /// The document as TOML, without comments, in the order of the schema.
    fn to_toml(&self) -> PyResult<String> {
        self.model.to_toml().map_err(|e| of_model(&e))
    }

    /// The document as JSON.
    fn to_json(&self) -> PyResult<String> {
        serde_json::to_string(&self.model.document).map_err(|e| error(Class::Model, e.to_string()))
    }

    /// Warnings about the model, although it can be computed.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        let each = self.model.warnings.iter();
        each.map(ToString::to_string).collect()
    }

    /// SHA-256 of the document and the tool.
    fn fingerprint(&self) -> PyResult<String> {
        let mut hash = Sha256::new();
        hash.update(self.to_toml()?.as_bytes());
        for number in matrix_of(&self.tool) {
            hash.update((number + 0.0).to_le_bytes());
        }
        Ok(hash.finalize().iter().map(|b| format!("{b:02x}")).collect())
    }

    fn tool<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        array(py, matrix_of(&self.tool), [4, 4])
    }

    fn home_pose<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        array(py, matrix_of(&self.home()), [4, 4])
    }

    fn with_tool(&self, tool: Numbers<'_>) -> PyResult<Self> {
        Ok(Self::new(self.model.clone(), one_pose("tool", &tool)?))
    }

    /// Name, kind, home, limits (or none), rating (or none), m and rad, N and N m.
    #[expect(clippy::type_complexity, reason = "a row for a dataclass of Python")]
    fn actuators(&self) -> Vec<(String, &'static str, f64, Option<(f64, f64)>, Option<f64>)> {
        let limbs = self.mechanism.limbs().iter();
        let each = limbs.flat_map(|limb| limb.nominal.actuators());
        let named = self.mechanism.actuator_names().into_iter();
        (named.zip(each).zip(self.model.ratings()))
            .map(|((name, a), rating)| (name, kind(a.kind), a.home, a.limits, rating))
            .collect()
    }

    /// Damping of vibrations as the file states it, see `kinetostat.Damping`.
    fn damping_json(&self) -> PyResult<String> {
        json_of(&self.model.damping())
    }

    fn platform_names(&self) -> Vec<String> {
        let each = self.mechanism.platforms().iter();
        each.map(|p| p.name.clone()).collect()
    }

    fn limb_names(&self) -> Vec<String> {
        let each = self.mechanism.limbs().iter();
        each.map(|limb| limb.name.clone()).collect()
    }

    /// The tool turns as the machine moves: it has fewer than six freedoms.
    fn turns_as_it_moves(&self) -> bool {
        self.turns()
    }

    /// Smallest and largest coordinates of the workspace that the file states, m.
    fn workspace(&self) -> Option<([f64; 3], [f64; 3])> {
        let (a, b) = self.model.workspace()?;
        Some((a.into(), b.into()))
    }

    fn natural_length(&self) -> f64 {
        self.mechanism.natural_length()
    }

    /// The machine commanded for a pose (1, 4, 4), near the joints of another posture.
    #[pyo3(signature = (target, near=None))]
    fn posture_at_pose(&self, target: Numbers<'_>, near: Option<&Posture>) -> PyResult<Posture> {
        let target = one_pose("pose", &target)?;
        match near {
            None => self.reach(&target),
            Some(near) => self.ask(PostureRequest::pose(&target).near(&near.0)),
        }
    }

    /// The machine commanded for a position, its orientation as at home; where the tool turns as the machine moves, the one
    /// nearest to that at home.
    #[pyo3(signature = (position, follows, near=None))]
    fn posture_at_position(
        &self,
        position: [f64; 3],
        follows: bool,
        near: Option<&Posture>,
    ) -> PyResult<Posture> {
        let position = Vector3::from(position);
        let rotation: UnitQuaternion<f64> = self.home().rotation;
        let pose = Pose::from_parts(position.into(), rotation);
        let request = match follows {
            true => PostureRequest::position(&position, &rotation),
            false => PostureRequest::pose(&pose),
        };
        match (follows, near) {
            (_, Some(near)) => self.ask(request.near(&near.0)),
            (true, None) => self.ask(request),
            (false, None) => self.reach(&pose),
        }
    }

    /// A posture that was: nothing is solved.
    fn posture_of_limbs(
        &self,
        target: Numbers<'_>,
        limbs: Vec<(Vec<f64>, Vec<f64>)>,
    ) -> PyResult<Posture> {
        let target = one_pose("pose", &target)?;
        let limbs = limbs.into_iter();
        let limbs = limbs.map(|(commands, coordinates)| LimbPosture {
            commands,
            coordinates,
        });
        self.ask(PostureRequest::joints(&target, limbs.collect()))
    }

    fn posture_at_joints(&self, joints: Vec<f64>) -> PyResult<Posture> {
        self.ask(PostureRequest::commands(&joints))
    }
}

impl Machine {
    /// Next to home, and of an arm that leaves its limits there in another configuration.
    fn reach(&self, pose: &Pose) -> PyResult<Posture> {
        let posture = self.mechanism.posture(pose);
        let left = posture
            .as_ref()
            .map_or(true, |p| p.within_limits().is_err());
        let posture = match left {
            true => self.configurations().posture(pose),
            false => posture,
        };
        posture
            .map(|p| Posture(Arc::new(p)))
            .map_err(|e| of_core(&e))
    }

    fn ask(&self, request: PostureRequest<'_>) -> PyResult<Posture> {
        let posture = self.mechanism.posture(request);
        posture
            .map(|p| Posture(Arc::new(p)))
            .map_err(|e| of_core(&e))
    }
}

/// Names of the machines that come along.
#[pyfunction]
pub fn preset_names() -> Vec<(&'static str, &'static str)> {
    let each = kinetostat_model::preset_names().iter();
    each.map(|preset| (preset.name, preset.description))
        .collect()
}

/// The model file of a robot's URDF, and what was skipped or looks wrong in it. `stiffness` is one number for all drives that turn
/// (N m/rad), `stiffness_table` a CSV with the header `name,value,unit`; `home` says of joints whether they turn and where they
/// stand (rad, m).
#[pyfunction]
#[pyo3(signature = (text, file, base=None, tip=None, passive=Vec::new(), home=BTreeMap::new(), stiffness=None, stiffness_table=None))]
pub fn urdf_to_toml(
    py: Python<'_>,
    text: &str,
    file: &str,
    base: Option<String>,
    tip: Option<String>,
    passive: Vec<String>,
    home: BTreeMap<String, (bool, f64)>,
    stiffness: Option<f64>,
    stiffness_table: Option<String>,
) -> PyResult<(String, Vec<String>)> {
    let mut options = UrdfOptions::default();
    (options.base, options.tip, options.passive) = (base, tip, passive);
    options.stiffness = match (stiffness, stiffness_table) {
        (_, Some(text)) => JointStiffness::Table {
            file: "joint_stiffness".to_owned(),
            text,
        },
        (Some(all), None) => JointStiffness::All(all),
        (None, None) => JointStiffness::Unknown,
    };
    let kind = |turning| match turning {
        true => MotionKind::Revolute,
        false => MotionKind::Prismatic,
    };
    let home = home.into_iter();
    options.home = home
        .map(|(name, (turning, at))| (name, (kind(turning), at)))
        .collect();
    let imported = py.detach(|| import_urdf(text, file, &options));
    let imported = imported.map_err(|e| of_model(&e))?;
    let notices = imported.notices.iter().map(ToString::to_string).collect();
    Ok((imported.toml, notices))
}
