//! A model: the document as written, and the mechanism it describes.

use std::path::Path;

use kinetostat::{Mechanism, Pose};
use kinetostat_dynamics::Damping;
use nalgebra::Vector3;

use crate::assembly::controller::{Controller, controller};
use crate::assembly::mechanism::assemble;
use crate::assembly::repair::others;
use crate::elements::damping::{damping, damping_place};
use crate::elements::placement::{corners, three_digits, written, written_pose};
use crate::elements::rotary::{RotaryAxis, rotary_axes};
use crate::findings::Findings;
use crate::plausibility::LimbCheck;
use crate::plausibility::home::{NOTHING_YIELDS, without_stiffness};
use crate::presets::{preset_text, unknown_preset};
use crate::problem::{Finding, KeyPath, ModelError, Problem, Severity};
use crate::schema::{Deviation, Document, Element};
use crate::text::check::{check, schema};
use crate::text::source::{MOST_BYTES, Source, read_text};

/// A machine, as written and as the core sees it.
#[derive(Clone, Debug)]
pub struct Model {
    /// Document as written in the file.
    pub document: Document,
    /// Mechanism that it describes, in SI units.
    pub mechanism: Mechanism,
    /// Map to the coordinates of the controller, if the file declares it.
    pub controller: Option<Controller>,
    /// The file's text (without a byte order mark).
    pub text: String,
    /// The file's name as it was given, or `preset NAME`.
    pub file: String,
    /// Implausible figures that can be computed with.
    pub warnings: Vec<Problem>,
}

impl Model {
    /// Reads a model from TOML text; `file` names it in messages.
    ///
    /// ```
    /// let text = kinetostat_model::preset_text("two_link").ok_or("no such preset")?;
    /// let model = kinetostat_model::Model::from_toml(text, "two_link.toml")?;
    /// assert_eq!(model.mechanism.limbs().len(), 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`ModelError`] with every problem found, each with its line and what to do.
    pub fn from_toml(text: &str, file: &str) -> Result<Self, ModelError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let refuse = |message: &str, help: &str| {
            Err(ModelError::new(vec![Problem::without_text(
                file,
                message.into(),
                help.into(),
            )]))
        };
        if text.len() > MOST_BYTES {
            return refuse(
                "the file is larger than 16 MB, which no model file is",
                "name a model file in TOML",
            );
        }
        if text.trim().is_empty() {
            return refuse(
                "the file is empty",
                "start from a preset: kinetostat model show two_link",
            );
        }
        let source = Source::parse(file, text)?;
        let mut findings = check(&source.tree);
        if !findings.is_empty() {
            findings.extend(others(&source, &findings));
            return Err(source.error(&findings));
        }
        let document =
            toml::from_str::<Document>(text).map_err(|e| source.error(&[Source::syntax(&e)]))?;
        let mut findings = Findings::default();
        let mut mechanism = assemble(&document, &mut findings);
        if let Some(mechanism) = mechanism.as_mut().filter(|_| findings.errors.is_empty()) {
            move_home_within_reach(mechanism, &mut findings);
        }
        let controller = mechanism
            .as_ref()
            .and_then(|m| controller(&document, m, &mut findings));
        let Some(mechanism) = mechanism.filter(|_| findings.errors.is_empty()) else {
            if findings.errors.is_empty() {
                findings.errors.push(Finding::new(
                    &KeyPath::root(),
                    "the machine could not be put together",
                    "please report this file: it should have had a better message",
                ));
            }
            return Err(source.error(&findings.errors));
        };
        let mut warnings: Vec<Problem> = findings
            .warnings
            .iter()
            .map(|f| source.problem(Severity::Warning, f))
            .collect();
        warnings.sort_by_key(|p| (p.line, p.column));
        Ok(Self {
            document,
            mechanism,
            controller,
            text: text.to_owned(),
            file: file.to_owned(),
            warnings,
        })
    }

    /// A model that comes with the program; see [`crate::preset_names`].
    ///
    /// # Errors
    /// [`ModelError`] with the nearest name if there is no such preset.
    pub fn preset(name: &str) -> Result<Self, ModelError> {
        match preset_text(name) {
            Some(text) => Self::from_toml(text, &format!("preset {name}")),
            None => Err(unknown_preset(name)),
        }
    }

    /// A preset by its name, or a file by its path: what a command line takes as MODEL. A file named
    /// like a preset is reached as `./NAME`.
    ///
    /// # Errors
    /// As [`preset`](Self::preset) for a plain word that is no file, else as
    /// [`crate::read_model`].
    pub fn open(name_or_path: &str) -> Result<Self, ModelError> {
        let path = Path::new(name_or_path);
        let word = !name_or_path.contains(['/', '\\', '.']);
        if preset_text(name_or_path).is_some() || (word && !path.exists()) {
            return Self::preset(name_or_path);
        }
        read_model(path)
    }

    /// Reads a model from a document, as if it had been read from the text that
    /// [`to_toml`](Self::to_toml) writes.
    ///
    /// # Errors
    /// As [`from_toml`](Self::from_toml).
    pub fn from_document(document: &Document, file: &str) -> Result<Self, ModelError> {
        Self::from_toml(&write(document, file)?, file)
    }

    /// Name of the machine.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.document.mechanism.name
    }

    /// Largest force (N) or torque (N m) of every drive that the file states, in the order of
    /// [`kinetostat::Mechanism::actuator_names`].
    #[must_use]
    pub fn ratings(&self) -> Vec<Option<f64>> {
        let limbs = self.document.limb.iter();
        limbs
            .filter_map(|limb| self.document.chain.get(&limb.chain))
            .flat_map(|chain| &chain.elements)
            .filter_map(|element| match element {
                Element::Actuator(a) => Some(a.rated_force_n.or(a.rated_torque_n_m)),
                _ => None,
            })
            .collect()
    }

    /// Refuses a machine in which nothing gives way: an answer about its deflections or its stiffness would be none.
    ///
    /// # Errors
    /// [`ModelError`] that says what is to be filled in.
    ///
    /// ```
    /// assert!(kinetostat_model::Model::preset("heavy_6r")?.require_stiffness().is_ok());
    /// # Ok::<(), kinetostat_model::ModelError>(())
    /// ```
    pub fn require_stiffness(&self) -> Result<(), ModelError> {
        require_stiffness(&self.mechanism, &self.file)
    }

    /// Returns the damping of the file; [`Damping::Undamped`] if it has none.
    ///
    /// ```
    /// use kinetostat_dynamics::Damping;
    /// use kinetostat_model::{Model, preset_text};
    ///
    /// let text = preset_text("two_link").ok_or("no such preset")?;
    /// assert_eq!(Model::from_toml(text, "two_link.toml")?.damping(), Damping::Undamped);
    /// let damped = format!("{text}\n[damping]\nratio = 0.03\nsource = \"ping test\"\n");
    /// assert_eq!(Model::from_toml(&damped, "two_link.toml")?.damping(), Damping::Ratio(0.03));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn damping(&self) -> Damping {
        damping(&self.document).unwrap_or(Damping::Undamped)
    }

    /// The line of the file that says how vibrations are damped: its law, or of several dampers the strongest one's.
    #[must_use]
    pub fn damping_line(&self) -> Option<usize> {
        self.line_of(&damping_place(&self.document)?)
    }

    /// The line at which the first limb of the file begins.
    #[must_use]
    pub fn first_limb_line(&self) -> Option<usize> {
        self.line_of(&KeyPath::root().key("limb").index(0))
    }

    /// The line that states the inertia of a platform or of a body; of that, `limb.body` is understood, too.
    #[must_use]
    pub fn inertia_line(&self, part: &str) -> Option<usize> {
        let mut platforms = self.mechanism.platforms().iter().skip(1);
        let place = match platforms.position(|platform| platform.name == part) {
            Some(index) => KeyPath::root()
                .key("platform")
                .index(index)
                .key("inertia_kg_m2"),
            None => self.body_place(part)?,
        };
        self.line_of(&place)
    }

    fn body_place(&self, part: &str) -> Option<KeyPath> {
        let limbs = self.mechanism.limbs().iter().enumerate();
        limbs.into_iter().find_map(|(limb, own)| {
            let of_limb = part.strip_prefix(&format!("{}.", own.name));
            let mut bodies = own.nominal.bodies().iter();
            let body =
                bodies.find(|body| body.name == part || Some(body.name.as_str()) == of_limb)?;
            let check = LimbCheck {
                document: &self.document,
                mechanism: &self.mechanism,
                limb,
                size: 0.0,
            };
            Some(check.place(&body.name, &["inertia_kg_m2"]))
        })
    }

    fn line_of(&self, place: &KeyPath) -> Option<usize> {
        let source = Source::parse(&self.file, &self.text).ok()?;
        let found = Finding::new(place, "", "");
        source.problem(Severity::Warning, &found).line
    }

    /// True for an arm: three revolute drives follow one another in a limb.
    #[must_use]
    pub fn is_arm(&self) -> bool {
        let turning = |limb: &kinetostat::Limb| {
            let drives = limb.nominal.actuators().iter();
            drives
                .filter(|a| a.kind == kinetostat::MotionKind::Revolute)
                .count()
        };
        self.mechanism.limbs().iter().any(|l| turning(l) >= 3)
    }

    /// Two opposite corners of the workspace in base axes, m: smallest and largest coordinates.
    #[must_use]
    pub fn workspace(&self) -> Option<(Vector3<f64>, Vector3<f64>)> {
        let (a, b) = corners(&self.document).ok()??;
        Some((a.inf(&b), a.sup(&b)))
    }

    /// Rotary axes by their words in programs, in the order of the file; none on most machines.
    ///
    /// ```
    /// let model = kinetostat_model::Model::preset("heavy_6r")?;
    /// assert!(model.rotary_axes().is_empty());
    /// # Ok::<(), kinetostat_model::ModelError>(())
    /// ```
    #[must_use]
    pub fn rotary_axes(&self) -> Vec<RotaryAxis> {
        let axes = rotary_axes(&self.document).into_iter();
        axes.filter_map(Result::ok).collect()
    }

    /// Adds an error of manufacture or assembly: the actual geometry of `limb` is moved by `motion` (m, in the frame
    /// reached behind the element) at the rigid element or link `at`, or at its `start` or `end`.
    ///
    /// # Errors
    /// [`ModelError`] if there is no such limb or element, if it has a deviation already, or if the motion is not finite.
    pub fn with_deviation(&self, limb: &str, at: &str, motion: &Pose) -> Result<Self, ModelError> {
        self.deviating(Deviation {
            limb: limb.to_owned(),
            at: at.to_owned(),
            moved_by: Some(written(motion)),
            ..Deviation::default()
        })
    }

    /// Adds an error of manufacture or assembly in the form of a file.
    ///
    /// # Errors
    /// [`ModelError`] as for a file with this deviation, also where the element has one already: the order of both motions is
    /// not stated.
    pub fn deviating(&self, deviation: Deviation) -> Result<Self, ModelError> {
        let mut document = self.document.clone();
        document.deviation.push(deviation);
        Self::from_document(&document, &self.changed())
    }

    /// Lines of messages about a changed document are not those of its file: the name says so.
    pub(crate) fn changed(&self) -> String {
        const MARK: &str = " (changed)";
        match self.file.ends_with(MARK) {
            true => self.file.clone(),
            false => format!("{}{MARK}", self.file),
        }
    }

    /// Returns the machine as drawn, without errors of manufacture and assembly.
    ///
    /// # Errors
    /// See [`from_toml`](Self::from_toml); cannot happen for a model that was read.
    pub fn without_deviations(&self) -> Result<Self, ModelError> {
        let mut document = self.document.clone();
        document.deviation.clear();
        Self::from_document(&document, &self.changed())
    }

    /// The document as TOML. Comments and order of the original text are not kept; use
    /// [`text`](Self::text) for those.
    ///
    /// # Errors
    /// [`ModelError`] if a value cannot be written; cannot happen for a model that was read.
    pub fn to_toml(&self) -> Result<String, ModelError> {
        write(&self.document, &self.file)
    }
}

/// Checks a mechanism like [`Model::require_stiffness`]; the message names its file.
///
/// # Errors
/// [`ModelError`] that says what is to be filled in.
pub fn require_stiffness(mechanism: &Mechanism, file: &str) -> Result<(), ModelError> {
    match without_stiffness(mechanism) {
        None => Ok(()),
        Some(help) => Err(ModelError::new(vec![Problem::without_text(
            file,
            NOTHING_YIELDS.to_owned(),
            help,
        )])),
    }
}

/// Reads a model file: UTF-8, with or without byte order mark, any line endings, at most 16 MB.
///
/// # Errors
/// [`ModelError`] if the file cannot be read or is not a model; says what to do.
pub fn read_model(path: &Path) -> Result<Model, ModelError> {
    let file = path.display().to_string();
    let text = read_text(path, &file)?;
    Model::from_toml(&text, &file)
}

/// Largest distance of a written home from a pose that the machine can take, m.
const ROUGH_HOME_M: f64 = 5e-3;

/// A home that is off by a few millimetres, only where the machine cannot move, is taken to the
/// nearest pose that it can take.
pub(crate) fn move_home_within_reach(mechanism: &mut Mechanism, findings: &mut Findings) {
    let Some(written) = mechanism.move_home_within_reach(ROUGH_HOME_M) else {
        return;
    };
    let tool = mechanism.tool();
    let home = mechanism.platforms()[tool].home;
    let off = kinetostat::spatial::pose_residual(&home, &written);
    // Platforms of the file are counted without the base.
    let place = KeyPath::root().key("platform").index(tool - 1).key("home");
    findings.warnings.push(Finding::new(
        &place,
        format!(
            "the machine cannot take this home exactly: the nearest pose, {} mm and {} deg away, is used",
            three_digits(1e3 * off.linear().norm()),
            three_digits(off.angular().norm().to_degrees())
        ),
        format!("to be exact, write {}", written_pose(&home)),
    ));
}

fn write(document: &Document, file: &str) -> Result<String, ModelError> {
    toml::to_string(document).map_err(|e| {
        ModelError::new(vec![Problem::without_text(
            file,
            format!("the model cannot be written as TOML: {e}"),
            "give every table a name that is plain text".into(),
        )])
    })
}

/// The JSON Schema of model files, pretty-printed, with a final newline.
#[must_use]
pub fn json_schema() -> String {
    let mut text = serde_json::to_string_pretty(schema()).unwrap_or_default();
    text.push('\n');
    text
}
