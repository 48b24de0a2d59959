// The client of Vibrissa's language server: it starts `vibrissa lsp` and lets the editor talk with it.
"use strict";

const { commands, window, workspace } = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;

async function start() {
  const command = workspace.getConfiguration("vibrissa").get("path");
  const starting = new LanguageClient(
    "vibrissa",
    "Vibrissa policies",
    { command, args: ["lsp"] },
    { documentSelector: [{ language: "fsm" }] },
  );
  client = starting;
  try {
    await starting.start();
  } catch (error) {
    client = undefined;
    window.showErrorMessage(
      `Cannot start \`${command} lsp\` (${error.message}). Build vibrissa with the feature \`lsp\`, and set \`vibrissa.path\` to it.`,
    );
  }
}

async function stop() {
  const stopping = client;
  client = undefined;
  await stopping?.stop();
}

async function restart() {
  await stop();
  await start();
}

function activate(context) {
  context.subscriptions.push(
    commands.registerCommand("vibrissa.restart", restart),
    workspace.onDidChangeConfiguration((change) => change.affectsConfiguration("vibrissa.path") && restart()),
  );
  return start();
}

module.exports = { activate, deactivate: stop };
