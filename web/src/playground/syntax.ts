import { HighlightStyle, StreamLanguage, syntaxHighlighting } from "@codemirror/language";
import type { Extension } from "@codemirror/state";
import { tags } from "@lezer/highlight";

/** The styles of the scopes, by their beginnings. */
const STYLES: readonly [scope: string, style: string][] = [
  ["storage.type", "definitionKeyword"],
  ["keyword.control", "controlKeyword"],
  ["keyword.operator", "operatorKeyword"],
  ["keyword.other.unit", "unit"],
  ["keyword", "keyword"],
  ["support.type", "typeName"],
  ["support.function", "function"],
  ["constant", "atom"],
  ["variable", "self"],
];

/** Colours of a policy's words. */
export function policySyntax(words: Record<string, string[]>): Extension {
  const styles = new Map<string, string>();
  for (const [scope, texts] of Object.entries(words)) {
    const style = STYLES.find(([start]) => scope.startsWith(start))?.[1];
    texts.forEach((text) => style !== undefined && styles.set(text, style));
  }
  const language = StreamLanguage.define<{ depth: number }>({
    startState: () => ({ depth: 0 }),
    token: (stream, state) => {
      if (stream.match(/^#.*/)) { return "comment"; }
      if (stream.match(/^"(?:[^"\\]|\\.)*"?/)) { return "string"; }
      if (stream.match(/^\d+(?:\.\d+)?(?:e[+-]?\d+)?/)) { return "number"; }
      const word = stream.match(/^[A-Za-z_][A-Za-z_0-9]*/) as RegExpMatchArray | null;
      if (word) { return styles.get(word[0]) ?? null; }
      const letter = stream.next();
      state.depth = Math.max(0, state.depth + (letter === "{" ? 1 : letter === "}" ? -1 : 0));
      return null;
    },
    indent: ({ depth }, after, { unit }) => unit * Math.max(0, depth - (after.startsWith("}") ? 1 : 0)),
    // A brace that the editor had closed would not be typed over on a later line.
    languageData: { commentTokens: { line: "#" }, closeBrackets: { brackets: ["(", "\""] }, indentOnInput: /^\s*\}$/ },
    tokenTable: { unit: tags.unit, function: tags.standard(tags.name), definitionKeyword: tags.definitionKeyword, controlKeyword: tags.controlKeyword, operatorKeyword: tags.operatorKeyword, typeName: tags.typeName, atom: tags.atom, self: tags.self },
  });
  return [language, colours];
}

/** Colours of a scenario: comments, keys, numbers. */
export function scenarioSyntax(): Extension {
  const language = StreamLanguage.define<null>({
    startState: () => null,
    token: (stream) => {
      if (stream.match(/^#.*/)) { return "comment"; }
      if (stream.match(/^"[^"]*"?/) || stream.match(/^'[^']*'?/)) { return "string"; }
      if (stream.match(/^[A-Za-z_][\w-]*(?=:)/)) { return "definitionKeyword"; }
      if (stream.match(/^-?\d+(?:\.\d+)?(?:e[+-]?\d+)?/)) { return "number"; }
      if (!stream.match(/^[\w-]+/)) { stream.next(); }
      return null;
    },
    languageData: { commentTokens: { line: "#" } },
    tokenTable: { definitionKeyword: tags.definitionKeyword },
  });
  return [language, colours];
}

const colours = syntaxHighlighting(HighlightStyle.define([
  { tag: tags.comment, class: "t-comment" },
  { tag: tags.string, class: "t-string" },
  { tag: [tags.number, tags.atom], class: "t-number" },
  { tag: tags.unit, class: "t-unit" },
  { tag: tags.definitionKeyword, class: "t-declaration" },
  { tag: [tags.controlKeyword, tags.keyword, tags.operatorKeyword], class: "t-keyword" },
  { tag: [tags.typeName, tags.standard(tags.name), tags.self], class: "t-name" },
]));
