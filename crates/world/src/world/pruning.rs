//! The report of what a run omits, with reasons.

use std::fmt;

use serde::Serialize;
use vibrissa_runtime::rig::Rig;

/// The treatment of a part of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// It is omitted. The run is bit-identical without it.
    LeftOut,
    /// It is kept.
    Kept,
    /// A physics setting reduces it. The run changes slightly.
    Setting,
}

/// A decision about a part of a run.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Decision {
    /// The treatment.
    pub verdict: Verdict,
    /// The subject of the decision.
    pub subject: String,
    /// The saving; `None` for a part that is kept.
    pub saves: Option<String>,
    /// The reason.
    pub why: String,
}

/// All decisions about a run. They follow from the scenario and from the values that the policy reads.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Pruning {
    /// The decisions.
    pub decisions: Vec<Decision>,
}

impl Pruning {
    /// The decisions of a simulator about a rig, and those about whiskers that a policy, which binds those with the names `bound`, does
    /// not read.
    #[must_use]
    pub fn new(mut decisions: Vec<Decision>, rig: &Rig, bound: &[String]) -> Self {
        unbound_whiskers(&mut decisions, rig, bound);
        Self { decisions }
    }
}

/// The decisions about whiskers that the policy does not bind. They are the same in every simulator.
fn unbound_whiskers(decisions: &mut Vec<Decision>, rig: &Rig, bound: &[String]) {
    for whisker in rig.whiskers.iter().filter(|whisker| !bound.contains(&whisker.name)) {
        decisions.push(Decision {
            verdict: Verdict::LeftOut,
            subject: format!("perception of `{}`", whisker.name),
            saves: Some("its filter, contact estimator and contour in every tick".to_owned()),
            why: "the policy does not bind it".to_owned(),
        });
        decisions.push(Decision {
            verdict: Verdict::Kept,
            subject: format!("the whisker `{}`", whisker.name),
            saves: None,
            why: "the policy does not bind it, but its contact forces act on the platform, and its penetration depth is limited"
                .to_owned(),
        });
    }
}

impl fmt::Display for Pruning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, Decision { verdict, subject, saves, why }) in self.decisions.iter().enumerate() {
            let verdict = match verdict {
                Verdict::LeftOut => "left out",
                Verdict::Kept => "kept",
                Verdict::Setting => "setting",
            };
            let line = if index > 0 { "\n" } else { "" };
            write!(f, "{line}{verdict:<10}{subject}")?;
            if let Some(saves) = saves {
                write!(f, "\n          saves: {saves}")?;
            }
            write!(f, "\n          why: {why}")?;
        }
        Ok(())
    }
}
