/** Saves a text as a file of the reader. */
export function download(name: string, type: string, text: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type }));
  link.download = name;
  link.click();
  // The browser has begun to read the text by then.
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/** A name for a file: letters, digits, points and hyphens. */
export function fileName(title: string, extension: string): string {
  return `${title.replace(/[^\p{L}\p{N}.]+/gu, "-").replace(/^-|-$/g, "")}.${extension}`;
}
