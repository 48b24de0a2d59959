import { autocompletion, closeBrackets, closeBracketsKeymap, completionKeymap, type CompletionContext, type CompletionResult } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap, indentWithTab, redo, undo } from "@codemirror/commands";
import { bracketMatching, indentOnInput, indentUnit } from "@codemirror/language";
import { lintGutter, lintKeymap, setDiagnostics, type Diagnostic } from "@codemirror/lint";
import { searchKeymap } from "@codemirror/search";
import { EditorState, Transaction, type Extension, type Text } from "@codemirror/state";
import { drawSelection, EditorView, highlightActiveLine, hoverTooltip, keymap, lineNumbers } from "@codemirror/view";
import { element } from "../shared/element.ts";
import type { Language, Position, Problem } from "./language.ts";

/** An editor of a text. */
export class Editor {
  readonly view: EditorView;

  #isBegun = false;

  /** `changed` learns of each change, and whether it is one of the reader. */
  constructor(parent: HTMLElement, label: string, changed: (text: string, isOfReader: boolean) => void, extensions: Extension[]) {
    const keys = element("p", "hint", "Tab indents; Esc, then Tab leaves. Ctrl+Enter runs.");
    keys.id = `${label}-keys`;
    const told = EditorView.updateListener.of((update) => {
      if (update.docChanged) {
        changed(update.state.doc.toString(), update.transactions.some((transaction) => transaction.annotation(Transaction.userEvent) !== undefined));
      }
    });
    this.view = new EditorView({
      parent,
      state: EditorState.create({
        extensions: [
          lineNumbers(), history(), drawSelection(), indentOnInput(), bracketMatching(), closeBrackets(), highlightActiveLine(),
          indentUnit.of("  "), EditorView.lineWrapping, EditorView.contentAttributes.of({ "aria-label": label, "aria-describedby": keys.id, spellcheck: "false" }),
          ...extensions,
          keymap.of([...closeBracketsKeymap, ...defaultKeymap, ...searchKeymap, ...historyKeymap, ...completionKeymap, ...lintKeymap, indentWithTab]),
          told,
        ],
      }),
    });
    parent.after(keys);
  }

  get text(): string {
    return this.view.state.doc.toString();
  }

  set text(text: string) {
    // There is nothing before the first text to which the reader could go back.
    const annotations = this.#isBegun ? [] : [Transaction.addToHistory.of(false)];
    this.#isBegun = true;
    this.view.dispatch({ changes: { from: 0, to: this.view.state.doc.length, insert: text }, annotations });
  }

  /** Takes the last change back, or makes it again. */
  undo(isAgain: boolean): void {
    (isAgain ? redo : undo)(this.view);
  }

  /** Shows diagnostics of the language server. */
  show(problems: readonly Problem[]): void {
    const { doc } = this.view.state;
    const diagnostics = problems.map(({ range, severity, code, message }): Diagnostic => {
      const from = offset(doc, range.start);
      return { from, to: Math.max(from, offset(doc, range.end)), severity: severity === 1 ? "error" : "warning", message: code === undefined ? message : `${message}\n${code}` };
    });
    this.view.dispatch(setDiagnostics(this.view.state, diagnostics));
  }

  /** Replaces the text by the formatted one. */
  async format(language: Language): Promise<void> {
    const before = this.view.state.doc;
    const edits = await language.format();
    if (this.view.state.doc === before) {
      this.view.dispatch({ changes: edits.map(({ range, newText }) => ({ from: offset(before, range.start), to: offset(before, range.end), insert: newText })), userEvent: "format" });
    }
  }
}

/** What the editor of a policy gets from the language server: hover texts and completion. */
export function services(language: Language): Extension[] {
  const hover = hoverTooltip(async (view, at) => {
    const text = await language.hover(position(view.state.doc, at));
    return text === undefined ? null : { pos: at, create: () => ({ dom: hoverText(text) }) };
  });
  const complete = async (context: CompletionContext): Promise<CompletionResult | null> => {
    const word = context.matchBefore(/[A-Za-z_0-9]+/);
    if (!context.explicit && word === null && !/[.>]$/.test(context.state.sliceDoc(Math.max(0, context.pos - 1), context.pos))) {
      return null;
    }
    const proposals = await language.complete(position(context.state.doc, context.pos));
    const options = proposals.map(({ label, detail, documentation, insertText, textEdit }) => ({
      label,
      apply: textEdit?.newText ?? insertText ?? label,
      ...(detail === undefined ? {} : { detail }),
      ...(documentation === undefined ? {} : { info: typeof documentation === "string" ? documentation : documentation.value }),
    }));
    return options.length === 0 ? null : { from: word?.from ?? context.pos, options, validFor: /^[A-Za-z_0-9]*$/ };
  };
  return [hover, autocompletion({ override: [complete] }), lintGutter()];
}

/** The parts of a hover text: code between fences, and paragraphs. It never becomes markup. */
function hoverText(markdown: string): HTMLElement {
  const box = element("div", "hover");
  markdown.split(/^```.*$/m).forEach((part, index) => {
    const text = part.trim();
    if (text !== "") {
      box.append(element(index % 2 === 1 ? "pre" : "p", "", text));
    }
  });
  return box;
}

function position(doc: Text, at: number): Position {
  const line = doc.lineAt(at);
  return { line: line.number - 1, character: at - line.from };
}

function offset(doc: Text, { line, character }: Position): number {
  if (line >= doc.lines) {
    return doc.length;
  }
  const { from, to } = doc.line(line + 1);
  return Math.min(from + character, to);
}
