//! Robots from other people's files.
//!
//! [`import_urdf`] reads a URDF and writes a model file of [`kinetostat_model`]: geometry, masses and
//! limits come from the URDF, which knows nothing that bends; joint stiffnesses and sections of
//! links are given beside it, or filled in afterwards where the written file says so.
//!
//! ```
//! let urdf = r#"<robot name="crane">
//!   <link name="post"/>
//!   <link name="boom"><inertial><origin xyz="0.5 0 0"/><mass value="20"/>
//!     <inertia ixx="0.1" ixy="0" ixz="0" iyy="1.7" iyz="0" izz="1.7"/></inertial></link>
//!   <joint name="shoulder" type="revolute">
//!     <origin xyz="0 0 1.5"/> <parent link="post"/> <child link="boom"/>
//!     <axis xyz="0 1 0"/> <limit lower="-1" upper="1" effort="0" velocity="1"/>
//!   </joint>
//!   <link name="hook"/>
//!   <joint name="end" type="fixed">
//!     <origin xyz="1 0 0"/> <parent link="boom"/> <child link="hook"/>
//!   </joint>
//! </robot>"#;
//! use kinetostat_import::{UrdfOptions, import_urdf};
//! let mut options = UrdfOptions::default();
//! options.tip = Some("hook".into());
//! let imported = import_urdf(urdf, "crane.urdf", &options)?;
//! let model = kinetostat_model::Model::from_toml(&imported.toml, "crane.toml")?;
//! assert_eq!(model.mechanism.actuator_names(), ["shoulder"]);
//! assert_eq!(imported.rigid_drives, ["shoulder"]); // to be filled in
//! # Ok::<(), kinetostat_model::ModelError>(())
//! ```
//!
//! # Decisions
//!
//! - **What moves or bends is read or refused, never dropped in silence.** What neither moves nor
//!   bends the robot (pictures, collisions, transmissions) is skipped with a notice.
//! - **Between base and tip every joint is an actuator**, unless it mimics another one (then it is
//!   coupled to it) or is said to be passive. Joints elsewhere stand still at home.
//! - **Side branches weigh.** Links fixed to the arm are bodies of the arm; links that a mimic joint
//!   moves (counterweights, pistons) hang on coupled motions that go out and come back.
//! - **Loops** are cut in the URDF and closed by `<constraint>` elements in it, or by the same in a
//!   loop file ([`LoopFile`]). Links where three ways meet become platforms.
//! - **DTDs are refused**, and files are refused by size before they are parsed: a file cannot make
//!   the importer use more than about a hundred times [`MOST_URDF_BYTES`].

mod log;
mod stiffness;
mod urdf;

pub use stiffness::JointStiffness;
pub use urdf::{
    Imported, LoopFile, MOST_URDF_BYTES, UrdfOptions, import_urdf, read_section, read_text,
};
