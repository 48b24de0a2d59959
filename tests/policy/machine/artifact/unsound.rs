//! Programs that no policy compiles to, one for every promise that running relies on.

use vibrissa_runtime::machine::{
    Artifact, ArtifactError, Guard, Keypoints, Mark, Message, MessageValue, Needs, Op, OutputKind, Outputs, Plot,
    Program, RateRange, State, Target, Transition, WhiskerScalar, WhiskerVector,
};
use vibrissa_runtime::units::Dimension;

use super::{erratic, policies};

/// What a changed program is refused with.
fn refusal(change: impl FnOnce(&mut Program)) -> String {
    let mut artifact = policies::everything();
    change(&mut artifact.program);
    let error = artifact.to_bytes().unwrap_err();
    assert!(matches!(error, ArtifactError::Unsound(_)), "{error}");
    error.to_string()
}

/// Index of the first operation of a kind.
fn find(program: &Program, is_kind: impl Fn(&Op) -> bool) -> usize {
    program.code.iter().position(is_kind).unwrap()
}

/// The register of the argument `w` of the state `Touch`.
fn whisker_argument(program: &Program) -> u16 {
    let record = find(program, |op| matches!(op, Op::Record { .. }));
    let Op::Record { whisker } = program.code[record] else { panic!("a record") };
    whisker
}

#[test]
fn registers_are_bounded() {
    let last = |program: &Program| u16::try_from(program.initial_registers.len() - 1).unwrap();
    let changes: [fn(&mut Op, u16); 14] = [
        |op, end| *op = Op::Copy { to: end + 1, a: 3 },
        |op, end| *op = Op::Copy { to: 5, a: end + 1 },
        |op, end| *op = Op::Norm { to: 5, a: end },
        |op, end| *op = Op::BodyPosition { to: end },
        |op, _| *op = Op::BodyPosition { to: u16::MAX },
        |op, end| *op = Op::SteerBodyFacing { along: end, speed: 0, heading: 0 },
        |op, end| *op = Op::Record { whisker: end + 1 },
        |op, end| *op = Op::Mark { whisker: end + 1, mark: Mark::Lost },
        |op, end| *op = Op::LowPass { to: 5, a: 3, b: 3, memory: end - 1 },
        |op, end| *op = Op::LowPass { to: 5, a: 3, b: end + 1, memory: end - 2 },
        |op, end| *op = Op::Pid { to: 5, a: 3, gains: end - 2, memory: end - 3 },
        |op, end| *op = Op::Pid { to: 5, a: 3, gains: end - 3, memory: end - 2 },
        |op, end| *op = Op::Clear { memory: end, count: 2 },
        |op, _| *op = Op::Clear { memory: u16::MAX, count: 4 },
    ];
    for change in changes {
        let told = refusal(|program| {
            let end = last(program);
            let plain = find(program, |op| matches!(op, Op::Add { .. }));
            change(&mut program.code[plain], end);
        });
        assert!(told.contains("names register"), "{told}");
    }
    let told = refusal(|program| {
        let end = last(program);
        let Guard::When { truth, .. } = &mut program.always[1].guard else { panic!("a condition") };
        *truth = end + 1;
    });
    assert!(told.contains("names register"), "{told}");
}

#[test]
fn jumps_lead_ahead_and_stay_in_their_block() {
    for by in [-1_i64, 0, 1000] {
        let told = refusal(|program| {
            let at = find(program, |op| matches!(op, Op::JumpUnless { .. }));
            let Op::JumpUnless { target, .. } = &mut program.code[at] else { panic!("a jump") };
            *target = u32::try_from(i64::try_from(at).unwrap() + by).unwrap();
        });
        assert!(told.contains("its jump at"), "{told}");
    }
}

#[test]
fn blocks_are_parts_of_the_code_that_do_not_cross() {
    let told = |change: fn(&mut Program)| assert!(refusal(change).contains("its block of code"));
    told(|program| program.states[1].body.end = u32::try_from(program.code.len()).unwrap() + 1);
    told(|program| program.states[1].body.start = program.states[1].body.end + 1);
    told(|program| program.states[1].body.start -= 1);
    told(|program| program.states[0].entry.end = u32::MAX);
    told(|program| program.states[0].entry.start -= 1);
    told(|program| program.states[0].exit.end += 1);
    told(|program| program.entry.end += 1);
    told(|program| program.body.end = u32::MAX);
    told(|program| program.monitors.end = u32::MAX);
    told(|program| {
        let Target::State { arguments, .. } = &mut program.states[1].transitions[0].target else { panic!("a state") };
        *arguments = 0..u32::try_from(program.code.len()).unwrap();
    });
    told(|program| program.fallback = Some(Target::State { state: 0, arguments: 1..u32::MAX, resume: false }));
    told(|program| {
        program.states[1].fallback = Some(Target::State { state: 0, arguments: u32::MAX..u32::MAX, resume: false });
    });
}

#[test]
fn monitors_only_change_memory() {
    let acts: [fn(&Op) -> bool; 3] = [
        |op| matches!(op, Op::Record { .. }),
        |op| matches!(op, Op::Mark { .. }),
        |op| matches!(op, Op::SteerWhiskerFacing { .. } | Op::SteerBodyFacing { .. }),
    ];
    for is_act in acts {
        let told = refusal(|program| {
            let act = program.code[find(program, is_act)];
            let at = program.monitors.start as usize;
            assert!(!program.monitors.is_empty());
            program.code[at] = act;
        });
        assert!(told.contains("its monitors record, or give a command"), "{told}");
    }
}

#[test]
fn plots_and_messages_are_bounded_and_read_registers_that_exist() {
    let plot = |value, kind| Plot { name: "p".to_owned(), kind, value, number: 0 };
    let message = |text: &str, kinds: Vec<OutputKind>| {
        let value = |kind| MessageValue { name: "n".into(), kind, value: 0 };
        Message { state: None, text: text.into(), values: kinds.into_iter().map(value).collect(), number: 0 }
    };
    let number = || OutputKind::Number(Dimension::NUMBER);
    let told = |change: &dyn Fn(&mut Outputs)| refusal(|program| change(&mut program.outputs));
    let plots = |plots: Vec<Plot>| told(&|outputs| outputs.plots.clone_from(&plots));
    let messages = |messages: Vec<Message>| told(&|outputs| outputs.messages.clone_from(&messages));
    assert!(plots(vec![plot(u16::MAX, number())]).contains("names register 65535"));
    assert!(plots(vec![plot(0, OutputKind::Whisker)]).contains("its plot or message `p`"));
    assert!(plots(vec![plot(0, number()); 2]).contains("`p`"));
    assert!(plots(vec![plot(0, number()); 33]).contains("33 plots"));
    assert!(messages(vec![message("a\n", vec![])]).contains("its plot or message"));
    assert!(messages(vec![message("a", vec![number(); 9])]).contains("its plot or message `a`"));
    assert!(messages(vec![Message { state: Some(2), ..message("a", vec![]) }]).contains("names state 2 of 2"));
    let vector = told(&|outputs| {
        let last = MessageValue { name: "n".into(), kind: OutputKind::Vector(Dimension::LENGTH), value: u16::MAX };
        outputs.messages = vec![Message { values: vec![last], ..message("a", vec![]) }];
    });
    assert!(vector.contains("names register 65536"), "{vector}");
}

#[test]
fn a_tick_does_no_code_twice() {
    let told = refusal(|program| {
        let longest = program.states[1].body.clone();
        for transition in program.states.iter_mut().flat_map(|state| &mut state.transitions) {
            let (Guard::When { code, .. } | Guard::After { code, .. }) = &mut transition.guard;
            *code = longest.clone();
        }
    });
    assert!(told.contains("its block of code"), "guards lie one behind the other: {told}");
    let told = refusal(|program| {
        let longest = program.states[1].body.clone();
        for state in &mut program.states {
            (state.entry, state.exit) = (longest.clone(), longest.clone());
        }
    });
    assert!(told.contains("operations a tick"), "{told}");
    let told = refusal(|program| {
        let longest = program.states[1].body.clone();
        (program.entry, program.body, program.start) = (longest.clone(), longest.clone(), longest);
    });
    assert!(told.contains("operations a tick"), "{told}");
    let told = refusal(|program| {
        let clear = find(program, |op| matches!(op, Op::Clear { .. }));
        program.code[clear] = Op::Clear { memory: 2, count: 5 };
    });
    assert!(told.contains("5 registers to clear at once"), "{told}");
}

#[test]
fn states_and_timers_are_bounded_and_timers_keep_to_their_kind() {
    assert!(refusal(|program| program.initial = 2).contains("names state 2 of 2"));
    assert!(refusal(|program| program.states.clear()).contains("of 0"));
    let told = refusal(|program| {
        let Target::State { state, .. } = &mut program.states[0].transitions[0].target else { panic!("a state") };
        *state = 9;
    });
    assert!(told.contains("names state 9 of 2"), "{told}");
    let stray = || Some(Target::State { state: 7, arguments: 0..0, resume: false });
    assert!(refusal(|program| program.fallback = stray()).contains("names state 7 of 2"));
    assert!(refusal(|program| program.states[1].fallback = stray()).contains("names state 7 of 2"));
    assert!(refusal(|program| program.timers = usize::MAX).contains("timers"));
    assert!(refusal(|program| program.timers = 0).contains("timers"));
    let told = refusal(|program| {
        let Guard::When { lasting: Some((_, timer)), .. } = &mut program.always[0].guard else { panic!("a duration") };
        *timer += 1;
    });
    assert!(told.contains("its timer 1"), "{told}");
}

#[test]
fn states_lie_in_those_before_them_and_begin_directly_in_themselves() {
    let told = |change: &dyn Fn(&mut Program)| {
        let mut artifact = policies::nested();
        change(&mut artifact.program);
        artifact.to_bytes().unwrap_err().to_string()
    };
    // Exploring, Following { Touching { Swiping, Pressing }, Searching, Retreating }, Tunnelling
    for (state, parent) in [(1, 1), (1, 2), (2, 2), (2, usize::MAX), (0, 7)] {
        let told = told(&|program| program.states[state].parent = Some(parent));
        assert!(told.contains(&format!("its state {state} has an invalid outer state")), "{told}");
    }
    for (state, initial) in [(1, 0), (1, 1), (1, 3), (1, 99), (0, 1), (3, 4), (7, 0)] {
        let told = told(&|program| program.states[state].initial = Some((initial, 0..0)));
        assert!(told.contains(&format!("its state {state} has an invalid initial state")), "{told}");
    }
    assert!(told(&|program| program.states[2].initial = None).contains("its state 2 has an invalid initial state"));
    assert!(told(&|program| program.states[5].parent = Some(0)).contains("its state 0 has an invalid initial state"));
    let told_of_resume = told(&|program| {
        program.states[6].transitions[0].target = Target::State { state: 5, arguments: 0..0, resume: true };
    });
    assert!(told_of_resume.contains("its state 5 has an invalid initial state"), "{told_of_resume}");
    let told_of_block = told(&|program| {
        let Some((_, arguments)) = &mut program.states[2].initial else { panic!("an initial state") };
        arguments.end = u32::MAX;
    });
    assert!(told_of_block.contains("its block of code"), "{told_of_block}");
    let deep = told(&|program| {
        let template = program.states[7].clone();
        for level in 0..8 {
            let (own, outer) = (program.states.len(), program.states.len() - 1);
            program.states[outer].initial = Some((own, 0..0));
            program.states.push(State { name: format!("S{level}").into(), parent: Some(outer), ..template.clone() });
        }
    });
    assert!(deep.contains("its state 15 has an invalid outer state, or is nested more than 8 deep"), "{deep}");
}

#[test]
fn the_blocks_of_the_states_around_a_state_count_with_its_own() {
    let mut artifact = policies::nested();
    let program = &mut artifact.program;
    let longest = program.states[6].body.clone();
    for state in &mut program.states[1..4] {
        (state.entry, state.body, state.exit) = (longest.clone(), longest.clone(), longest.clone());
        if let [Transition { guard: Guard::When { code, .. } | Guard::After { code, .. }, .. }] =
            &mut state.transitions[..]
        {
            *code = longest.clone();
        }
    }
    let told = artifact.to_bytes().unwrap_err().to_string();
    assert!(told.contains("operations a tick"), "{told}");
}

#[test]
fn what_is_read_as_a_whisker_only_ever_holds_one() {
    let told = |change: &dyn Fn(&mut Program, u16)| {
        let told = refusal(|program| change(program, whisker_argument(program)));
        assert!(told.contains("read as a whisker"), "{told}");
    };
    let replace = |program: &mut Program, op| {
        let plain = find(program, |op| matches!(op, Op::Add { .. }));
        program.code[plain] = op;
    };
    for index in [2.0, -1.0, 0.5, 1e300] {
        told(&|program, whisker| program.initial_registers[usize::from(whisker)] = index);
    }
    told(&|program, whisker| replace(program, Op::Time { to: whisker }));
    told(&|program, whisker| replace(program, Op::BodyPosition { to: whisker - 1 }));
    told(&|program, whisker| replace(program, Op::LowPass { to: whisker + 1, a: 3, b: 3, memory: whisker - 2 }));
    told(&|program, whisker| replace(program, Op::Pid { to: whisker, a: 3, gains: 3, memory: whisker + 1 }));
    told(&|program, whisker| replace(program, Op::Clear { memory: whisker, count: 1 }));
    told(&|program, whisker| {
        // Through another register: what is copied counts too.
        let through = whisker + 1;
        replace(program, Op::Copy { to: whisker, a: through });
        let other = find(program, |op| matches!(op, Op::Multiply { .. }));
        program.code[other] = Op::Time { to: through };
    });
    told(&|program, whisker| replace(program, Op::Copy { to: whisker, a: 1 }));
    told(&|program, whisker| replace(program, Op::Select { to: whisker, condition: 3, a: whisker, b: 1 }));
    told(&|program, whisker| replace(program, Op::Select { to: whisker, condition: 3, a: 1, b: whisker }));
    told(&|program, _| replace(program, Op::Whisker { to: 9, whisker: 1, quantity: WhiskerScalar::Yaw }));
    told(&|program, _| {
        program.whiskers.pop();
    });
}

/// A program with a whisker, two contours of positions, and a state that takes a contour.
fn with_contours() -> Artifact {
    let text = "machine m whisker a contour c contour d of 16 points 20 mm apart initial A
        state A { record a.tip in d  when d.ready and a.touching -> B(c) }
        state B(x: contour) { steer body along x.tangent at 1 m/s turning 0 rad/s  when x.ready for 1 s -> B(a.contour) }
        always when time > 1 s -> Failure(\"late\")";
    policies::artifact("contours.fsm", text)
}

#[test]
fn contours_exist_and_have_enough_points() {
    let told = |change: &dyn Fn(&mut Program), expected: &str| {
        let mut artifact = with_contours();
        assert!(artifact.to_bytes().is_ok());
        change(&mut artifact.program);
        let told = artifact.to_bytes().unwrap_err().to_string();
        assert!(told.contains(expected), "{told}");
    };
    let tangent = |op: &Op| matches!(op, Op::WhiskerVector { quantity: WhiskerVector::ContourTangent, .. });
    let argument = |program: &Program| {
        let Op::WhiskerVector { whisker, .. } = program.code[find(program, tangent)] else { panic!("a tangent") };
        usize::from(whisker)
    };
    for index in [3.0, -1.0, 0.5] {
        told(
            &|program| {
                let argument = argument(program);
                program.initial_registers[argument] = index;
            },
            "read as a contour",
        );
    }
    // Without the last contour, its index is too large.
    told(&|program| drop(program.contours.pop()), "contour 1 of 1");
    let set = |program: &mut Program, keypoints| program.contours[1].keypoints = keypoints;
    for (count, spacing) in [(2, 0.01), (17, 0.01), (7, 0.0), (7, 0.021), (7, f64::NAN)] {
        let keypoints = Keypoints { count, spacing };
        told(&|program| set(program, keypoints), "too few, too many, too close or too far");
        told(&|program| program.keypoints = keypoints, "too few, too many, too close or too far");
    }
    told(&|program| program.contours[0].name = "a".to_owned(), "`a` occurs twice");
    told(&|program| program.contours.resize(9, program.contours[0].clone()), "9 contours, 8 at most are allowed");
    // What every contour may be is not always a whisker.
    told(
        &|program| {
            let whisker = u16::try_from(argument(program)).unwrap();
            let op = find(program, tangent);
            let Op::WhiskerVector { to, .. } = program.code[op] else { panic!("a tangent") };
            program.code[op] = Op::WhiskerVector { to, whisker, quantity: WhiskerVector::Tip };
        },
        "read as a whisker",
    );
}

#[test]
fn parameters_stay_what_they_are() {
    let told = refusal(|program| {
        let plain = find(program, |op| matches!(op, Op::Add { .. }));
        program.code[plain] = Op::Copy { to: 0, a: 3 };
    });
    assert!(told.contains("changes the parameter `fast`"), "{told}");
    for op in [
        Op::Clear { memory: 1, count: 3 },
        Op::LowPass { to: 9, a: 3, b: 3, memory: 1 },
        Op::Pid { to: 9, a: 3, gains: 3, memory: 1 },
    ] {
        let told = refusal(|program| {
            let plain = find(program, |op| matches!(op, Op::Add { .. }));
            program.code[plain] = op;
        });
        assert!(told.contains("changes the parameter `free`"), "{told}");
    }
    let changes: [fn(&mut Program); 5] = [
        |program| program.initial_registers[0] = 0.3,
        |program| program.parameters[0].default = -1.0,
        |program| program.parameters[0].range = Some((1.0, 0.0)),
        |program| program.parameters[0].range = Some((f64::NEG_INFINITY, f64::INFINITY)),
        |program| program.parameters[0].range = Some((f64::NAN, f64::NAN)),
    ];
    for change in changes {
        assert!(refusal(change).contains("`fast` is outside of its range"));
    }
    assert!(refusal(|program| program.parameters[1].default = f64::NAN).contains("`free`"));
    let choose = |program: &mut Program, choices: &[&str], range, value| {
        program.parameters[0].choices = choices.iter().map(|&choice| choice.to_owned()).collect();
        (program.parameters[0].range, program.parameters[0].default) = (range, value);
        program.initial_registers[0] = value;
    };
    for (range, value) in [(None, 0.0), (Some((0.0, 1.0)), 0.5), (Some((0.0, 2.0)), 2.0), (Some((-1.0, 1.0)), -1.0)] {
        let told = refusal(|program| choose(program, &["no", "yes"], range, value));
        assert!(told.contains("`fast` is outside of its range"), "{told}");
    }
    let told = refusal(|program| choose(program, &["no", "no"], Some((0.0, 1.0)), 0.0));
    assert!(told.contains("`no` occurs twice"), "{told}");
}

#[test]
fn the_image_is_finite() {
    for number in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(refusal(|program| *program.initial_registers.last_mut().unwrap() = number).contains("not finite"));
    }
}

#[test]
fn names_and_reasons_are_plain() {
    for name in ["", "9", "a b", "a\n", "\u{1b}[2J", "\u{fc}ber"] {
        assert!(refusal(|program| program.name = name.to_owned()).contains("is not a name"), "{name:?}");
        assert!(refusal(|program| program.whiskers[1] = name.to_owned()).contains("is not a name"), "{name:?}");
        assert!(refusal(|program| program.states[1].name = name.into()).contains("is not a name"), "{name:?}");
        assert!(refusal(|program| program.parameters[1].name = name.to_owned()).contains("is not a name"), "{name:?}");
    }
    assert!(refusal(|program| program.whiskers[1] = "a".to_owned()).contains("`a` occurs twice"));
    let told = refusal(|program| program.always[0].target = Target::Failure("\u{1b}[2J".into()));
    assert!(told.contains(r"\u{1b}"), "{told}");
    let told = refusal(|program| program.states[0].fallback = Some(Target::Failure("\n".into())));
    assert!(told.contains(r"\n"), "{told}");
    let told = refusal(|program| program.always[0].target = Target::Success("\t".into()));
    assert!(told.contains(r"\t"), "{told}");
    for text in ["a\nb".to_owned(), "long".repeat(100)] {
        let mut artifact = policies::everything();
        artifact.origin.file = text;
        assert!(matches!(artifact.to_bytes(), Err(ArtifactError::Origin(_))));
    }
}

#[test]
fn counts_are_bounded() {
    let told = |change: fn(&mut Program)| assert!(refusal(change).contains("at most are allowed"));
    told(|program| program.whiskers = (0..9).map(|index| format!("w{index}")).collect());
    told(|program| program.code.resize(50_001, Op::Stop));
    told(|program| program.initial_registers.resize(60_001, 0.0));
    told(|program| program.states.resize(50_001, program.states[0].clone()));
    told(|program| program.always.resize(50_001, program.always[0].clone()));
    told(|program| program.initial_registers.truncate(1));
}

#[test]
fn whiskers_are_read_only_where_one_is_bound() {
    let told = refusal(|program| program.whiskers.clear());
    assert!(told.contains("bind one, as in `whisker r0`"), "{told}");
}

#[test]
fn a_source_map_fits_its_program() {
    let mut artifact = policies::everything();
    artifact.positions.states[1].transitions.pop();
    assert_eq!(artifact.to_bytes(), Err(ArtifactError::Positions));
}

#[test]
fn the_stated_work_of_a_tick_is_that_of_the_code() {
    let whole = policies::everything();
    let actual = whole.program.most_operations();
    for stated in [0, actual - 1, actual + 1, usize::MAX] {
        let artifact = Artifact { most_operations: stated, ..whole.clone() };
        assert_eq!(artifact.to_bytes(), Err(ArtifactError::Operations { stated, actual }));
    }
}

#[test]
fn needs_are_positive_in_order_and_have_a_whole_ratio() {
    let range = |low, high| Some(RateRange { low, high });
    for age in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let told = refusal(|program| program.needs.sample_age = Some(age));
        assert!(told.contains("its needs"), "{told}");
    }
    for (control_rate, sample_rate) in [
        (range(30.0, 20.0), None),
        (range(0.0, 20.0), None),
        (None, range(-1.0, 20.0)),
        (None, range(1.0, f64::INFINITY)),
        (range(f64::NAN, 20.0), None),
        (range(40.0, 45.0), range(50.0, 70.0)),
    ] {
        let told = refusal(|program| program.needs = Needs { control_rate, sample_rate, sample_age: None });
        assert!(told.contains("its needs"), "{told}");
    }
}

#[test]
fn the_largest_machine_fits_into_an_artifact_and_runs() {
    let mut artifact = policies::everything();
    let program = &mut artifact.program;
    let (from, free) =
        (u32::try_from(program.code.len()).unwrap(), u16::try_from(program.initial_registers.len()).unwrap());
    program.initial_registers.resize(60_000, -1.0 / 3.0);
    program.code.resize(50_000, Op::Rotate { to: 59_998, a: free, b: 59_000 });
    program.states[0].body = from..50_000;
    artifact.most_operations = program.most_operations();
    let bytes = artifact.to_bytes().unwrap();
    erratic::run(Artifact::from_bytes(&bytes).unwrap().program);
}

#[test]
fn a_description_is_one_short_line() {
    for description in ["two\nlines".to_owned(), "x".repeat(501), "\u{1b}[31mred".to_owned()] {
        let told = refusal(|program| program.parameters[0].description = description);
        assert!(told.contains("description"), "{told}");
    }
}
