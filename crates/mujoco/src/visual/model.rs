//! The drawn model: objects, platform, floor and light.

use std::fmt::{self, Write};

use mujoco_rs::prelude::{MjData, MjModel};

use crate::mjcf::{half_height, named_parts, write_assets, write_part};
use crate::prune::Scope;
use crate::world::MujocoError;
use vibrissa_runtime::math;
use vibrissa_world::geometry::Pose;
use vibrissa_world::physics::Physics;
use vibrissa_world::scene::Scene;
use vibrissa_world::solid::{Part, convex_parts};

use super::camera::Camera;

/// Side of a square of the floor (m).
const SQUARE: f64 = 0.1;
/// The distance (m) between the objects and the strokes above them.
const ABOVE: f64 = 1e-3;

/// The height (m) at which strokes are above all objects.
#[must_use]
pub fn top(physics: &Physics) -> f64 {
    half_height(physics) + ABOVE
}

/// The drawn model of a scene.
pub(super) struct VisualModel {
    pub(super) data: MjData<Box<MjModel>>,
}

impl VisualModel {
    /// Builds the model for pictures of at most this width and height (px).
    ///
    /// # Errors
    /// [`MujocoError`] if MuJoCo's library cannot be used, if a solid is too large for it, or if it rejects the model.
    pub(super) fn new(scene: &Scene, camera: &Camera, size: [u32; 2]) -> Result<Self, MujocoError> {
        super::super::messages::prepare_engine()?;
        let refused = |error: &dyn fmt::Display| MujocoError::Model(error.to_string());
        let mut xml = String::new();
        let parts = convex_parts(&scene.solids).map_err(MujocoError::Undrawable)?;
        write_model(&mut xml, scene, &parts, camera, size).map_err(|error| refused(&error))?;
        let model = MjModel::from_xml_string(&xml).map_err(|error| refused(&error))?;
        let mut visual = Self { data: MjData::try_new(Box::new(model)).map_err(|error| refused(&error))? };
        visual.place(&scene.start);
        Ok(visual)
    }

    pub(super) fn model(&self) -> &MjModel {
        self.data.model()
    }

    /// Moves the platform to a pose (world frame).
    pub(super) fn place(&mut self, body: &Pose) {
        let (sin, cos) = math::sin_cos(0.5 * body.heading);
        if let Some(position) = self.data.mocap_pos_mut().first_mut() {
            *position = [body.position.x, body.position.y, 0.0];
        }
        if let Some(orientation) = self.data.mocap_quat_mut().first_mut() {
            *orientation = [cos, 0.0, 0.0, sin];
        }
        self.data.forward();
    }
}

fn write_model(
    xml: &mut String,
    scene: &Scene,
    parts: &[Part],
    camera: &Camera,
    [width, height]: [u32; 2],
) -> fmt::Result {
    let half_height = half_height(&scene.physics);
    let parts = named_parts(parts, &Scope::whole(&scene.rig, parts));
    let [elevation, azimuth] = Camera::angles_deg();
    // The window looks from 1.5 times the extent.
    let extent = camera.distance() / 1.5;
    let middle = camera.looks_at;
    writeln!(xml, r#"<mujoco model="vibrissa">"#)?;
    writeln!(xml, r#"  <compiler angle="radian" usethread="false"/>"#)?;
    writeln!(xml, r#"  <statistic center="{} {} 0" extent="{extent}"/>"#, middle.x, middle.y)?;
    writeln!(xml, r"  <visual>")?;
    writeln!(
        xml,
        r#"    <global offwidth="{width}" offheight="{height}" fovy="{}" azimuth="{azimuth}" elevation="{elevation}"/>"#,
        camera.field_of_view.to_degrees()
    )?;
    writeln!(xml, r#"    <quality offsamples="4" shadowsize="0"/>"#)?;
    writeln!(xml, r#"    <headlight ambient="0.45 0.45 0.45" diffuse="0.55 0.55 0.55" specular="0 0 0"/>"#)?;
    writeln!(xml, r"  </visual>")?;
    write_assets(xml, &scene.rig.platform, &parts, half_height)?;
    writeln!(xml, r"  <asset>")?;
    writeln!(xml, r#"    <texture type="skybox" builtin="flat" rgb1="1 1 1" width="8" height="48"/>"#)?;
    writeln!(
        xml,
        r#"    <texture name="/floor" type="2d" builtin="checker" rgb1="1 1 1" rgb2="0.95 0.955 0.965" width="64" height="64"/>"#
    )?;
    // A texture has two squares in each direction.
    let repeats = 0.5 / SQUARE;
    writeln!(
        xml,
        r#"    <material name="/floor" texture="/floor" texuniform="true" texrepeat="{repeats} {repeats}" specular="0"/>"#
    )?;
    writeln!(xml, r#"    <material name="/object" rgba="0.72 0.76 0.80 1" specular="0"/>"#)?;
    writeln!(xml, r#"    <material name="/platform" rgba="0.32 0.38 0.43 1" specular="0"/>"#)?;
    writeln!(xml, r"  </asset>")?;
    writeln!(xml, r"  <worldbody>")?;
    writeln!(xml, r#"    <geom type="plane" size="0 0 1" pos="0 0 {}" material="/floor"/>"#, -half_height - ABOVE)?;
    for (name, part) in &parts {
        write_part(xml, name, part, half_height, r#"material="/object""#)?;
    }
    writeln!(xml, r#"    <body mocap="true"><geom type="mesh" mesh="platform" material="/platform"/></body>"#)?;
    writeln!(xml, r"  </worldbody>")?;
    writeln!(xml, r"</mujoco>")
}
