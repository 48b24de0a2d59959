//! The configuration of Alloy: labels for the log of the robot and of the services.

use std::collections::BTreeSet;

use vibrissa_robot::fault::FaultKind;
use vibrissa_runtime::machine::Program;

/// The configuration. It reads the journal of the system, where containers and the robot's own service write. Without a
/// `path`, that is `/run/log/journal`, where Raspberry Pi OS keeps it since May 2025, and `/var/log/journal`.
pub(super) fn configuration(program: &Program, robot: &str) -> String {
    let faults = FaultKind::ALL.map(FaultKind::name).join("|");
    let states: BTreeSet<&str> = program.states.iter().map(|state| &*state.name).collect();
    let states: Vec<&str> = states.into_iter().collect();
    let states = states.join("|");
    let machine = &program.name;
    format!(
        r#"// Alloy reads the journal and sends the lines of Vibrissa and of its services to Loki. `vibrissa setup services generate` has made this
// file for the machine {machine}: its states and the kinds of faults are labels.

discovery.relabel "journal" {{
  targets = []

  rule {{
    source_labels = ["__journal__systemd_unit"]
    regex         = "vibrissa-(.+)\\.service"
    target_label  = "service"
  }}

  rule {{
    source_labels = ["__journal_container_tag"]
    regex         = "vibrissa/vibrissa-(.+)-[0-9]+"
    target_label  = "service"
  }}
}}

// Without a path, it reads both folders of the journal: /run/log/journal and /var/log/journal.
loki.source.journal "journal" {{
  max_age       = "12h"
  relabel_rules = discovery.relabel.journal.rules
  labels        = {{robot = "{robot}"}}
  forward_to    = [loki.process.vibrissa.receiver]
}}

loki.process "vibrissa" {{
  forward_to = [loki.write.loki.receiver]

  stage.match {{
    selector = "{{robot=\"{robot}\", service=\"\"}}"
    action   = "drop"
  }}

  stage.regex {{
    expression = " s: (?P<fault>{faults}): "
  }}

  stage.regex {{
    expression = " s: state (?P<state>{states}): "
  }}

  stage.labels {{
    values = {{fault = "", state = ""}}
  }}
}}

loki.write "loki" {{
  endpoint {{
    url = "http://loki:3100/loki/api/v1/push"
  }}
}}
"#
    )
}
