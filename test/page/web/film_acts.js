// What the tests do with films, on a page that can import its modules.

/** A file of these bytes, in base 64. */
const makeFile = (data, name) =>
  new File([Uint8Array.from(atob(data), (each) => each.charCodeAt(0))], name);

/** The middle of what is red in a picture of a film. */
const findRed = ({ canvas, picture }) => {
  const { data } = picture.getImageData(0, 0, canvas.width, canvas.height);
  let [count, x, y] = [0, 0, 0];
  for (let k = 0; k < data.length; k += 4) {
    if (data[k] < 180 || data[k + 1] > 130) continue;
    count += 1;
    x += ((k / 4) % canvas.width) + 0.5;
    y += Math.floor(k / 4 / canvas.width) + 0.5;
  }
  return [x / count, y / count];
};

/** Open a film, at a rate if one is given; its size and times, and what is red in some of its frames. */
window.readFilm = async ([data, name, frames, rate, sort]) => {
  const { Film } = await import("/film/film.js");
  const { findSort } = await import("/film/sorts.js");
  const file = makeFile(data, name);
  const film = await Film.open(file, sort ?? (await findSort(file)));
  if (rate) film.setRate(rate);
  const found = [];
  for (const frame of frames) {
    await film.show(frame);
    found.push([film.place, film.seen, ...findRed(film)]);
  }
  const { width, height, times, isReal, rates } = film;
  film.close();
  return { width, height, times: [...times], isReal, rates, rate: film.rate, found };
};

/** What a file is, and why it is refused as a film. */
window.refuseFilm = async ([data, name]) => {
  const { Film } = await import("/film/film.js");
  const { findSort } = await import("/film/sorts.js");
  const file = makeFile(data, name);
  const sort = await findSort(file);
  try {
    await Film.open(file, sort);
  } catch (error) {
    return [sort, error.message];
  }
  return [sort, ""];
};

/** Suggestions for frames in turn, from clicks in the first ones: [kind, x, y] each. */
window.followBall = async ([data, name, clicks, step]) => {
  const { Film } = await import("/film/film.js");
  const { findSort } = await import("/film/sorts.js");
  const { findBall, findLook, joinLooks, predict } = await import("/film/ball.js");
  const file = makeFile(data, name);
  const film = await Film.open(file, await findSort(file));
  const [balls, looks] = [new Map(clicks), []];
  for (const [frame, place] of clicks) {
    await film.show(frame);
    const look = findLook(film.picture, place);
    if (look) looks.push(look);
  }
  const found = [];
  if (!looks.length) return "no look";
  for (let frame = clicks.at(-1)[0] + step; frame < film.times.length; frame += step) {
    await film.show(frame);
    const expected = predict(balls, film.times, frame);
    const answer = findBall(film.picture, joinLooks([...looks]), expected);
    found.push([frame, answer.kind, ...(answer.place ?? [])]);
    if (answer.kind !== "found") break;
    balls.set(frame, answer.place);
  }
  film.close();
  return found;
};
