// Errors in words. A refusal is a RangeError with its sentence; any other error is a bug.

/** @param {unknown} error */
export const nameError = (error) => {
  const text = error instanceof Error ? error.message : String(error);
  if (error instanceof RangeError) return text;
  console.error(error);
  return `this failed because of a bug in the page: ${text}`;
};
