//! Lowering of tests and properties. Their code is not part of the program.

use std::collections::HashMap;
use std::sync::Arc;

use crate::ast::{Expression, File, Kind, Name, Setting, Test, TestScenes};
use crate::suggestion::did_you_mean;
use crate::test::{self, Expectation, FigureRegister, PlotFigure, PolicyTest, RunFigure};
use crate::types::{Type, Value};
use vibrissa_runtime::machine::{Op, OutputKind, Parameter, Register};
use vibrissa_text::diagnostic::{Diagnostic, Span};

use super::Compiler;
use super::scope::Scope;

impl<'f> Compiler<'f> {
    /// Lowers the tests of a file with these parameters.
    pub(super) fn tests(&mut self, file: &'f File, parameters: &[Parameter]) {
        for (index, test) in file.tests.iter().enumerate() {
            if let Some(first) = file.tests[..index].iter().find(|first| first.title.text == test.title.text) {
                let message = format!("two tests have the title \"{}\"", test.title.text);
                let diagnostic = Diagnostic::error("P0202", message, test.title.span, "again here");
                self.report(diagnostic.note(first.title.span, "first here").hint("give each test its own title"));
            }
            let test = self.test(test, parameters);
            self.tests.extend(test);
        }
    }

    fn test(&mut self, test: &'f Test, parameters: &[Parameter]) -> Option<PolicyTest> {
        if test.expectations.is_empty() {
            let diagnostic = Diagnostic::error("P0703", "there is no expectation", test.title.span, "cannot fail");
            self.report(diagnostic.hint("write `expect run.completed`, or another condition on the run"));
        }
        let file = match &test.scenes {
            TestScenes::Scenario(file) => Some(file),
            TestScenes::Family { .. } => None,
        };
        for text in std::iter::once(&test.title).chain(file) {
            if text.text.chars().any(char::is_control) {
                let message = "the text has a control character";
                let diagnostic =
                    Diagnostic::error("P0703", message, text.span, "has a tab or another control character");
                self.report(diagnostic.hint("use only letters, digits, signs and spaces"));
            }
        }
        let scenes = match &test.scenes {
            TestScenes::Scenario(Name { text, span }) => {
                Some(test::TestScenes::Scenario { file: text.clone(), span: *span })
            }
            TestScenes::Family { family, ranges } => self.family(family, ranges, test, parameters),
        };
        let settings = test.settings.iter().filter_map(|setting| self.setting(setting, parameters)).collect();
        let expectations = test.expectations.iter().filter_map(|truth| self.expectation(truth)).collect();
        let (title, title_span) = (test.title.text.clone(), test.title.span);
        Some(PolicyTest { title, title_span, scenes: scenes?, settings, expectations })
    }

    fn setting(&mut self, (name, value): &'f (Name, Setting), parameters: &[Parameter]) -> Option<(usize, f64)> {
        if let Some(None) = self.names().globals.get(name.text.as_str()) {
            // The error in the parameter has been reported.
            return None;
        }
        let Some(index) = parameters.iter().position(|parameter| parameter.name == name.text) else {
            if self.is_told("P0201", name.span) {
                return None;
            }
            let message = format!("there is no parameter `{}`", name.text);
            let diagnostic = Diagnostic::error("P0201", message, name.span, "unknown parameter");
            let known = parameters.iter().map(|parameter| parameter.name.as_str());
            self.report(did_you_mean(diagnostic, &name.text, known));
            return None;
        };
        self.value_of(value, &parameters[index]).map(|value| (index, value))
    }

    fn expectation(&mut self, truth: &'f Expression) -> Option<Expectation> {
        let (mark, before) = (self.code.mark(), self.code.initial.len());
        let start = self.code.here() as usize;
        self.figures = Some(Vec::new());
        let value = self.expect(&Scope::default(), truth, Type::Bool);
        let figures = self.figures.take().unwrap_or_default();
        let code = self.code.ops.get(start..).unwrap_or_default().to_vec();
        // All tests share the registers of the program. There may be thousands of both.
        let program = match &self.tested {
            Some(program) if program.len() == before => Arc::clone(program),
            _ => Arc::from(self.code.initial.get(..before).unwrap_or_default()),
        };
        self.tested = Some(Arc::clone(&program));
        let own = self.code.initial.get(before..).unwrap_or_default().to_vec();
        self.code.rewind(mark);
        self.memories.clear();

        let value = value?;
        if figures.is_empty() || code.iter().any(reads_a_tick) {
            let (message, label) = if code.iter().any(reads_a_tick) {
                ("a sensor value of one tick is not a figure of the whole run", "reads a sensor value of one tick")
            } else {
                ("the expectation does not depend on the run", "the same for every run")
            };
            let diagnostic = Diagnostic::error("P0703", message, truth.span, label);
            self.report(diagnostic.hint("expect something of `run`, such as `run.error_mean < 0.5 mm`"));
            return None;
        }
        Some(Expectation { span: truth.span, code, initial: [program, own.into()], result: value.register, figures })
    }

    /// A register for a figure of the run.
    pub(super) fn figure(&mut self, figure: RunFigure, span: Span) -> Register {
        let register = self.code.allocate(1);
        if let Some(figures) = &mut self.figures {
            figures.push(FigureRegister { register, figure, span });
        }
        register
    }

    /// A figure of the plot that `values` names.
    pub(super) fn figure_of_plot(
        &mut self,
        figure: PlotFigure,
        name: &'f Name,
        values: Option<&'f [Expression]>,
    ) -> Option<Value> {
        let plot = match values {
            Some([Expression { kind: Kind::Root { name, values: None }, .. }]) => Some(name),
            _ => None,
        };
        let Some(plot) = plot else {
            let message = format!("`{}` needs the name of one plot", name.text);
            let diagnostic = Diagnostic::error("P0304", message, name.span, "no plot is named");
            self.report(
                diagnostic.hint(format!("write `run.{}(name)` with the name of a `plot` statement", name.text)),
            );
            return None;
        };
        let plots = &self.code.outputs.plots;
        let Some(index) = plots.iter().position(|known| known.name == plot.text) else {
            let message = format!("there is no plot `{}`", plot.text);
            let diagnostic = Diagnostic::error("P0201", message, plot.span, "unknown plot");
            let diagnostic = did_you_mean(diagnostic, &plot.text, plots.iter().map(|known| known.name.as_str()));
            self.report(diagnostic.hint("a statement of the policy gives it values: `plot name = value`"));
            return None;
        };
        let r#type = match plots[index].kind {
            OutputKind::Number(dimension) => Type::Scalar(dimension),
            OutputKind::Truth => Type::Bool,
            OutputKind::Choice(_) | OutputKind::Vector(_) | OutputKind::Whisker => {
                let message = format!("the plot `{}` has neither numbers nor bools", plot.text);
                let diagnostic = Diagnostic::error("P0301", message, plot.span, "has values of an enumeration");
                self.report(diagnostic.hint("plot the comparison with a value: `plot is_left = side == Side.left`"));
                return None;
            }
        };
        Some(Value { r#type, register: self.figure(RunFigure::Plot(figure, index), name.span) })
    }

    /// A register for a figure of the run and of the state that `values` names.
    pub(super) fn run_of_state(
        &mut self,
        figure: fn(usize) -> RunFigure,
        name: &'f Name,
        values: Option<&'f [Expression]>,
    ) -> Option<Register> {
        let path = match values {
            Some([value]) => path(value).map(|path| (path, value.span)),
            _ => None,
        };
        let Some((state, span)) = path else {
            let message = format!("`{}` needs the name of one state", name.text);
            let diagnostic = Diagnostic::error("P0304", message, name.span, "no state is named");
            self.report(diagnostic.hint(format!("write `run.{}(Name)`", name.text)));
            return None;
        };
        let hierarchy = &self.hierarchy;
        let paths = self.paths.get_or_insert_with(|| {
            let paths = (0..hierarchy.states.len()).rev().map(|index| (hierarchy.path(index), index));
            paths.collect()
        });
        let Some(&index) = paths.get(&state) else {
            if self.is_told("P0201", span) {
                return None;
            }
            let message = format!("there is no state `{state}`");
            let diagnostic = Diagnostic::error("P0201", message, span, "unknown state");
            let known = self.paths.iter().flat_map(HashMap::keys).map(String::as_str);
            let diagnostic = did_you_mean(diagnostic, &state, known);
            self.report(diagnostic);
            return None;
        };
        Some(self.figure(figure(index), name.span))
    }
}

/// The text of a state's name, or of names with dots: `Following.Swiping`.
fn path(value: &Expression) -> Option<String> {
    match &value.kind {
        Kind::Root { name, values: None } => Some(name.text.clone()),
        Kind::Member { owner, name, values: None } => Some(format!("{}.{}", path(owner)?, name.text)),
        _ => None,
    }
}

/// True if an operation reads senses or has memory. Expectations allow neither.
fn reads_a_tick(op: &Op) -> bool {
    matches!(
        op,
        Op::Time { .. }
            | Op::Body { .. }
            | Op::BodyPosition { .. }
            | Op::Whisker { .. }
            | Op::WhiskerVector { .. }
            | Op::TipAt { .. }
            | Op::LoopClosed { .. }
            | Op::ContourAt { .. }
            | Op::Map { .. }
            | Op::MapVector { .. }
            | Op::MapHolds { .. }
            | Op::LowPass { .. }
            | Op::Pid { .. }
            | Op::Count { .. }
    )
}
