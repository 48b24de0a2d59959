//! The MuJoCo model of a rig among solids, as MJCF.
//!
//! The platform is one body on two slides and a hinge, driven by velocity servos. Every whisker is a chain of rigid
//! links on planar hinges. The joint springs represent the bending stiffness of the shaft by the trapezoid rule:
//! `EI / l` between two links of length `l`, and twice that at the root, because only half a link bends there. With
//! sixteen links, the base moment differs from the elastica's by less than 0.1 %. In a tapered shaft, each link has the
//! mean thickness.
//!
//! A cable has the layout of MuJoCo's composite of that name. Its first link is clamped to the base, and the others are
//! on ball joints. MuJoCo's cable plugin replaces the springs.
//!
//! A spatial chain has a second hinge at the base, and one at every second link. Their axes are transverse and
//! horizontal. A chain of links that are twice as long has half of the joint stiffness. Only this model has gravity.

use std::fmt::{self, Write};

use vibrissa_runtime::math;
use vibrissa_runtime::rig::{Platform, Rig, Shaft, Whisker};
use vibrissa_world::geometry::{Point2, Pose, Vector2, unit};
use vibrissa_world::physics::{GRAVITY, Physics, ShaftModel, Solver, link_inertia, weight_moment};

use super::contacts::{Contacts, friction_stiffness};
use super::prune::Scope;
use vibrissa_world::solid::{Part, PartsError, Solid, convex_parts};

/// Half of the height (m) of the platform, and of objects in a planar simulation. There, any height is possible.
const HALF_HEIGHT: f64 = 0.01;
/// The height (m) by which the farthest vertex of a prism is lowered. Hundreds of coplanar vertices would slow down the
/// computation of faces, and later the support function.
const DOME: f64 = 1e-3;

/// Mass (kg) and moment of inertia (kg m²) of a whisker's base. The suspension's inertia is the armature of the hinge.
/// MuJoCo requires a positive mass of the body.
const BASE_MASS: f64 = 1e-6;
const BASE_INERTIA: f64 = 1e-9;

/// The name of MuJoCo's cable plugin.
const CABLE: &str = "mujoco.elasticity.cable";

/// The ratio of Young's modulus and shear modulus for a Poisson's ratio of 0.3. It has no effect, because there is no
/// torsion in the plane.
const YOUNG_OVER_SHEAR: f64 = 2.6;

/// Writes the MuJoCo model of `rig` at `start` among `solids`.
///
/// Names in the model:
/// - the body and the geom `platform/body`
/// - the joints `platform/x`, `platform/y` and `platform/yaw`, each with an actuator of the same name
/// - for a whisker `w`: the joint `w`, its sensor, and the joints and geoms `w.0`, `w.1`, … along the shaft. A cable
///   has no joint `w.0`, but an instance `w` of the plugin. A spatial chain also has joints `w/up`, `w.0/up`, `w.2/up`, …
/// - the geom `object`, or `object/0`, `object/1`, … if there are several convex parts
/// - the keyframe `start`
///
/// # Errors
/// [`PartsError`] if a solid is too large for MuJoCo.
pub fn mjcf(rig: &Rig, physics: &Physics, solids: &[Solid], start: Pose) -> Result<String, PartsError> {
    let parts = convex_parts(solids)?;
    Ok(mjcf_within(&rig.vibrating(), physics, &parts, start, &Scope::whole(rig, &parts)))
}

/// Writes what is in `scope` of the model with all these `parts` of solids. A rigid whisker is one body without joints and geoms. The other
/// names are the same.
#[must_use]
pub(crate) fn mjcf_within(rig: &Rig, physics: &Physics, parts: &[Part], start: Pose, scope: &Scope) -> String {
    let parts = named_parts(parts, scope);
    let mut xml = String::new();
    // Writing to a string cannot fail.
    let _ = write_model(&mut xml, rig, physics, &parts, start, scope);
    xml
}

/// Those of all parts that are in the scope, ascending, with the names of their geoms.
pub(super) fn named_parts<'p>(parts: &'p [Part], scope: &Scope) -> Vec<(String, &'p Part)> {
    let name = |index: usize| if parts.len() == 1 { "object".to_owned() } else { format!("object/{index}") };
    let parts = parts.iter().enumerate().filter(|(index, _)| scope.has_part(*index));
    parts.map(|(index, part)| (name(index), part)).collect()
}

/// The names of the geoms of the parts in `scope`, ascending by the parts' indices.
#[cfg(feature = "sim")]
pub(crate) fn part_names(parts: &[Part], scope: &Scope) -> impl Iterator<Item = String> {
    named_parts(parts, scope).into_iter().map(|(name, _)| name)
}

fn write_model(
    xml: &mut String,
    rig: &Rig,
    physics: &Physics,
    parts: &[(String, &Part)],
    start: Pose,
    scope: &Scope,
) -> fmt::Result {
    writeln!(xml, r#"<mujoco model="vibrissa">"#)?;
    writeln!(xml, r#"  <compiler angle="radian" autolimits="true" inertiafromgeom="false" usethread="false"/>"#)?;
    // With a pyramidal friction cone, a tip that slides with a small coefficient vibrates; with an elliptic cone it does
    // not. docs/decisions/mujoco.md#the-contact-solver-is-projected-gauss-seidel-without-islands compares the solvers.
    writeln!(
        xml,
        r#"  <option timestep="{}" integrator="{}" solver="{}" cone="elliptic"{}{} gravity="0 0 {}" jacobian="dense">"#,
        physics.step,
        physics.integrator.name(),
        physics.solver.name(),
        friction_stiffness(physics),
        tolerance(physics),
        if physics.shafts == ShaftModel::SpatialChain { -GRAVITY } else { 0.0 }
    )?;
    // One tree of bodies is one island. The search for islands would take a quarter of the time.
    writeln!(xml, r#"    <flag island="disable"/>"#)?;
    writeln!(xml, r"  </option>")?;
    if physics.shafts == ShaftModel::Cable {
        write_extension(xml, rig, scope)?;
    }
    let contacts = Contacts::with(parts.len(), physics, scope);
    contacts.write_defaults(xml, physics)?;
    let half_height = half_height(physics);
    write_assets(xml, &rig.platform, parts, half_height)?;
    writeln!(xml, r"  <worldbody>")?;
    for (name, part) in parts {
        write_part(xml, name, part, half_height, contacts.of_part())?;
    }
    write_platform(xml, rig, physics, contacts, scope)?;
    writeln!(xml, r"  </worldbody>")?;
    if !parts.is_empty() {
        contacts.write_pairs(xml, rig, physics, scope, parts)?;
    }
    write_actuators(xml, &rig.platform)?;
    if rig.sensing.forces {
        writeln!(xml, r"  <sensor>")?;
        for whisker in &rig.whiskers {
            writeln!(xml, r#"    <force name="{0}" site="{0}"/>"#, whisker.name)?;
        }
        writeln!(xml, r"  </sensor>")?;
    }
    write_start(xml, rig, physics, start, scope)?;
    writeln!(xml, r"</mujoco>")
}

/// Half of the height (m) of objects.
pub(super) fn half_height(physics: &Physics) -> f64 {
    if physics.shafts == ShaftModel::SpatialChain { 0.5 * physics.object_height } else { HALF_HEIGHT }
}

fn write_extension(xml: &mut String, rig: &Rig, scope: &Scope) -> fmt::Result {
    writeln!(xml, "  <extension>\n    <plugin plugin=\"{CABLE}\">")?;
    for (_, whisker) in scope.flexible(rig) {
        let young = whisker.shaft.young_modulus;
        writeln!(xml, r#"      <instance name="{}">"#, whisker.name)?;
        for (key, value) in [("twist", young / YOUNG_OVER_SHEAR), ("bend", young)] {
            writeln!(xml, r#"        <config key="{key}" value="{value}"/>"#)?;
        }
        writeln!(xml, "      </instance>")?;
    }
    writeln!(xml, "    </plugin>\n  </extension>")
}

/// The option attribute for the tolerance of the projected Gauss-Seidel solver. A tip between two parts of a wall
/// touches both. With the default of 1e-8, this takes some 70 iterations with hardly any change of the force.
fn tolerance(physics: &Physics) -> &'static str {
    if physics.solver == Solver::ProjectedGaussSeidel { r#" tolerance="1e-6""# } else { "" }
}

pub(super) fn write_assets(
    xml: &mut String,
    platform: &Platform,
    parts: &[(String, &Part)],
    half_height: f64,
) -> fmt::Result {
    writeln!(xml, r"  <asset>")?;
    write_prism(xml, "platform", &platform.outline_body(), HALF_HEIGHT)?;
    for (name, part) in parts {
        if let Part::Prism { outline } = part {
            write_prism(xml, name, outline, half_height)?;
        }
    }
    writeln!(xml, r"  </asset>")
}

/// Writes an upright prism with domed ends.
fn write_prism(xml: &mut String, name: &str, outline: &[Point2], half_height: f64) -> fmt::Result {
    let sum = outline.iter().fold(Vector2::zeros(), |sum, corner| sum + corner.coords);
    let middle = Point2::from(sum / outline.len() as f64);
    // Points of a circle, lowered by their squared distance, would be coplanar again.
    let from_middle =
        |corner: &Point2| (corner - middle).dot(&Vector2::new(corner.x - middle.x, 2.0 * (corner.y - middle.y)));
    let farthest = outline.iter().map(from_middle).fold(f64::MIN_POSITIVE, f64::max);
    write!(xml, r#"    <mesh name="{name}" vertex=""#)?;
    for corner in outline {
        let (x, y, top) = (corner.x, corner.y, half_height - DOME * from_middle(corner) / farthest);
        write!(xml, "{x} {y} {} {x} {y} {top} ", -top)?;
    }
    writeln!(xml, r#""/>"#)
}

/// Writes the geom of a part, with further `attributes`.
pub(super) fn write_part(xml: &mut String, name: &str, part: &Part, half_height: f64, attributes: &str) -> fmt::Result {
    match part {
        Part::Cylinder { centre, radius } => writeln!(
            xml,
            r#"    <geom name="{name}" type="cylinder" pos="{} {} 0" size="{radius} {half_height}" {attributes}/>"#,
            centre.x, centre.y
        ),
        Part::Prism { .. } => writeln!(xml, r#"    <geom name="{name}" type="mesh" mesh="{name}" {attributes}/>"#),
    }
}

fn write_platform(xml: &mut String, rig: &Rig, physics: &Physics, contacts: Contacts, scope: &Scope) -> fmt::Result {
    let Platform { mass, inertia, .. } = rig.platform;
    writeln!(xml, r#"    <body name="platform/body">"#)?;
    writeln!(xml, r#"      <inertial pos="0 0 0" mass="{mass}" diaginertia="{inertia} {inertia} {inertia}"/>"#)?;
    writeln!(xml, r#"      <joint name="platform/x" type="slide" axis="1 0 0"/>"#)?;
    writeln!(xml, r#"      <joint name="platform/y" type="slide" axis="0 1 0"/>"#)?;
    writeln!(xml, r#"      <joint name="platform/yaw" type="hinge" axis="0 0 1"/>"#)?;
    let mask = contacts.of_rig();
    writeln!(xml, r#"      <geom name="platform/body" type="mesh" mesh="platform" {mask}/>"#)?;
    for (index, whisker) in rig.whiskers.iter().enumerate() {
        // The body has no name, so that a whisker's name cannot collide with a name of MuJoCo such as `world`.
        writeln!(
            xml,
            r#"      <body pos="{} {} 0" {}>"#,
            whisker.base_body.x,
            whisker.base_body.y,
            orientation(whisker, physics.shafts)
        )?;
        if scope.is_rigid(index) {
            write_rigid(xml, whisker)?;
        } else {
            write_whisker(xml, whisker, physics.shafts, mask)?;
        }
    }
    writeln!(xml, r"    </body>")
}

/// The orientation of the base of a whisker, as an attribute. A spatial chain has a pitch.
fn orientation(whisker: &Whisker, model: ShaftModel) -> String {
    let Whisker { direction_body, pitch, .. } = whisker;
    if model != ShaftModel::SpatialChain {
        return format!(r#"euler="0 0 {direction_body}""#);
    }
    let (ahead, up) = (unit(*direction_body), unit(*pitch));
    format!(r#"xyaxes="{} {} {} {} {} 0""#, ahead.x * up.x, ahead.y * up.x, up.y, -ahead.y, ahead.x)
}

/// Writes a rigid whisker without geoms: only its mass, in the undeflected position.
fn write_rigid(xml: &mut String, whisker: &Whisker) -> fmt::Result {
    let shaft = &whisker.shaft;
    let links = || (0..shaft.links).map(|link| (shaft.link_mass(link), (link as f64 + 0.5) * shaft.link_length()));
    let mass = BASE_MASS + links().map(|(mass, _)| mass).sum::<f64>();
    let centre = links().map(|(mass, along)| mass * along).sum::<f64>() / mass;
    let of_links = links()
        .enumerate()
        .map(|(link, (mass, along))| link_inertia(shaft, link) + mass * math::square(along - centre));
    let inertia = BASE_INERTIA + BASE_MASS * centre * centre + of_links.sum::<f64>();
    writeln!(
        xml,
        r#"        <inertial pos="{centre} 0 0" mass="{mass}" diaginertia="{inertia} {inertia} {inertia}"/>"#
    )?;
    writeln!(xml, r#"        <site name="{}"/>"#, whisker.name)?;
    writeln!(xml, "      </body>")
}

fn write_whisker(xml: &mut String, whisker: &Whisker, model: ShaftModel, mask: &str) -> fmt::Result {
    let (name, shaft, hinge) = (&whisker.name, &whisker.shaft, &whisker.hinge);
    let length = shaft.link_length();
    writeln!(
        xml,
        r#"        <inertial pos="0 0 0" mass="{BASE_MASS:e}" diaginertia="{BASE_INERTIA:e} {BASE_INERTIA:e} {BASE_INERTIA:e}"/>"#
    )?;
    writeln!(
        xml,
        r#"        <joint name="{name}" type="hinge" axis="0 0 1" stiffness="{}" damping="{}" armature="{}"/>"#,
        hinge.stiffness, hinge.damping, hinge.armature
    )?;
    if model == ShaftModel::SpatialChain {
        writeln!(
            xml,
            r#"        <joint name="{name}/up" type="hinge" axis="0 1 0" stiffness="{}" damping="{}" armature="{}"/>"#,
            hinge.stiffness, hinge.damping, hinge.armature
        )?;
    }
    writeln!(xml, r#"        <site name="{name}"/>"#)?;
    for (link, (stiffness, rest)) in shaft.joint_stiffnesses().zip(shaft.rest_angles()).enumerate() {
        let at = if link == 0 { 0.0 } else { length };
        let turned = if rest == 0.0 { String::new() } else { format!(r#" euler="0 0 {rest}""#) };
        let (mass, inertia) = (shaft.link_mass(link), link_inertia(shaft, link));
        writeln!(
            xml,
            r#"        <body pos="{at} 0 0"{turned}><inertial pos="{} 0 0" mass="{mass}" diaginertia="{inertia} {inertia} {inertia}"/>"#,
            length / 2.0
        )?;
        let damping = stiffness * shaft.damping;
        match model {
            ShaftModel::Chain | ShaftModel::SpatialChain => writeln!(
                xml,
                r#"          <joint name="{name}.{link}" type="hinge" axis="0 0 1" stiffness="{stiffness}" damping="{damping}"/>"#
            )?,
            ShaftModel::Cable => {
                if link > 0 {
                    let armature = hinge.armature;
                    writeln!(
                        xml,
                        r#"          <joint name="{name}.{link}" type="ball" damping="{damping}" armature="{armature}"/>"#
                    )?;
                }
                writeln!(xml, r#"          <plugin instance="{name}"/>"#)?;
            }
        }
        if model == ShaftModel::SpatialChain && ShaftModel::bends_out_of_plane(link) {
            let stiffness = stiffness_out_of_plane(shaft, stiffness);
            let damping = stiffness * shaft.damping;
            writeln!(
                xml,
                r#"          <joint name="{name}.{link}/up" type="hinge" axis="0 1 0" stiffness="{stiffness}" damping="{damping}"/>"#
            )?;
        }
        writeln!(
            xml,
            r#"          <geom name="{name}.{link}" type="capsule" fromto="0 0 0 {length} 0 0" size="{}" {mask}/>"#,
            shaft.link_radius(link)
        )?;
    }
    writeln!(xml, "      {}</body>", "</body>".repeat(shaft.links))
}

/// Stiffness (N m/rad) of the transverse hinge of a link whose hinge in the plane has the stiffness `in_plane`.
fn stiffness_out_of_plane(shaft: &Shaft, in_plane: f64) -> f64 {
    0.5 * shaft.out_of_plane * in_plane
}

/// The joint angles (rad) of an undeflected whisker. A spatial chain droops under its weight. Its angles are those of
/// small deflections: the moment of the weight beyond a joint over the stiffness of the joint.
fn angles_at_rest(whisker: &Whisker, model: ShaftModel) -> String {
    let shaft = &whisker.shaft;
    match model {
        ShaftModel::Chain => " 0".repeat(1 + shaft.links),
        ShaftModel::Cable => format!(" 0{}", " 1 0 0 0".repeat(shaft.links.saturating_sub(1))),
        ShaftModel::SpatialChain => {
            let moment = |joint: usize| weight_moment(shaft, joint) * unit(whisker.pitch).x;
            let mut angles = format!(" 0 {}", moment(0) / whisker.hinge.stiffness);
            for (link, in_plane) in shaft.joint_stiffnesses().enumerate() {
                angles.push_str(" 0");
                if ShaftModel::bends_out_of_plane(link) {
                    // Writing to a string cannot fail.
                    let _ = write!(angles, " {}", moment(link) / stiffness_out_of_plane(shaft, in_plane));
                }
            }
            angles
        }
    }
}

fn write_actuators(xml: &mut String, platform: &Platform) -> fmt::Result {
    writeln!(xml, r"  <actuator>")?;
    let joints = [("platform/x", platform.mass), ("platform/y", platform.mass), ("platform/yaw", platform.inertia)];
    for ((joint, inertia), servo) in joints.into_iter().zip(&platform.servos()) {
        // A velocity servo with the gain k moves the inertia J with the time constant J / k.
        writeln!(xml, r#"    <velocity name="{joint}" joint="{joint}" kv="{}"/>"#, inertia / servo)?;
    }
    writeln!(xml, r"  </actuator>")
}

fn write_start(xml: &mut String, rig: &Rig, physics: &Physics, start: Pose, scope: &Scope) -> fmt::Result {
    let at_rest = scope.flexible(rig).map(|(_, whisker)| angles_at_rest(whisker, physics.shafts));
    writeln!(
        xml,
        "  <keyframe>\n    <key name=\"start\" qpos=\"{} {} {}{}\"/>\n  </keyframe>",
        start.position.x,
        start.position.y,
        start.heading,
        at_rest.collect::<String>()
    )
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use vibrissa_world::physics::MIN_INERTIA;

    /// The values of an attribute, in the order of the model.
    fn values<'x>(xml: &'x str, attribute: &str) -> Vec<&'x str> {
        let opening = format!(" {attribute}=\"");
        xml.split(&opening).skip(1).map(|rest| rest.split('"').next().unwrap()).collect()
    }

    #[test]
    fn no_name_of_a_whisker_can_be_taken_already() {
        let mut rig = Rig::default();
        for (whisker, name) in rig.whiskers.iter_mut().zip(["world", "object"]) {
            name.clone_into(&mut whisker.name);
        }
        rig.sensing.forces = true;
        let xml = mjcf(&rig, &Physics::default(), &[], Pose::default()).unwrap();
        for element in ["<body", "<joint", "<geom", "<site", "<force", "<velocity"] {
            let tags: String = xml.split(element).skip(1).map(|rest| rest.split('>').next().unwrap()).collect();
            let mut names = values(&tags, "name");
            if element == "<body" {
                names.push("world");
            }
            let count = names.len();
            names.sort_unstable();
            names.dedup();
            assert_eq!(names.len(), count, "{element}: {names:?}");
        }
    }

    #[test]
    fn a_tapered_whisker_gets_thinner_lighter_and_softer_from_link_to_link() {
        let mut rig = Rig::default();
        rig.whiskers.truncate(1);
        rig.whiskers[0].shaft.tip_radius = Some(0.025e-3);
        let xml = mjcf(&rig, &Physics::default(), &[], Pose::default()).unwrap();
        for (element, attribute) in
            [("<geom name=\"r0.", "size"), ("<inertial pos=\"0.003", "mass"), ("<joint name=\"r0.", "stiffness")]
        {
            let tags: String = xml.split(element).skip(1).map(|rest| rest.split('>').next().unwrap()).collect();
            let values: Vec<f64> = values(&tags, attribute).iter().map(|value| value.parse().unwrap()).collect();
            assert_eq!(values.len(), 16, "{element}");
            assert!(values.windows(2).all(|pair| pair[1] < pair[0]), "{element}: {values:?}");
        }
    }

    #[test]
    fn every_inertia_of_a_thin_wire_is_one_that_the_engine_takes() {
        for (radius, links) in [(0.06e-3, 16), (0.075e-3, 64), (0.02e-3, 64)] {
            let mut rig = Rig::default();
            (rig.whiskers[0].shaft.radius, rig.whiskers[0].shaft.links) = (radius, links);
            let xml = mjcf(&rig, &Physics::default(), &[], Pose::default()).unwrap();
            for inertias in values(&xml, "diaginertia") {
                let moments: Vec<f64> = inertias.split(' ').map(|moment| moment.parse().unwrap()).collect();
                let [x, y, z] = moments[..] else { panic!("three moments, found {inertias}") };
                assert!(x.min(y).min(z) >= MIN_INERTIA && x + y >= z && y + z >= x && z + x >= y, "{inertias}");
            }
        }
    }
}
