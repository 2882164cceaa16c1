/* Score a trajectory against a problem of the test set: score.py in C++17, in one file.

     g++ -O2 -std=c++17 score.cpp -o score
     ./score                          # lists the problems
     ./score cusps trajectory.csv     # scores a trajectory
     ./score cusps.turned turned.csv  # that of another description of the body

It reads problems.csv and states.csv next to the program, and prints what score.py prints. */

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <iterator>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

using Row = std::vector<double>;
using Strings = std::vector<std::string>;
using Quaternion = std::array<double, 4>;  // w, x, y, z
using Vector = std::array<double, 3>;

const Strings QUATERNION = {"w", "x", "y", "z"}, RATES = {"wx", "wy", "wz"};
const Strings DESCRIPTIONS = {"turned", "offset", "nested", "nested_half"};  // of the body
const Strings WORLD_RATES = {"omega_x", "omega_y", "omega_z"};
constexpr double SAME_TIME = 1e-9;  // relatively: a clock that adds up its steps
constexpr double LARGEST_NORM_ERROR = 0.01, LARGEST_NUMBER = 1e100;
// An error above SMALL (rad, or part of the largest rate) is a mistake if it is MUCH smaller without.
constexpr double SMALL = 0.05, MUCH = 10.0;
constexpr std::size_t SHOWN = 60;
const char SPACES[] = " \t\r\n\v\f";

struct Refused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// ---- text

std::string strip(const std::string& text, const char* characters = SPACES) {
  const auto begin = text.find_first_not_of(characters);
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_last_not_of(characters) - begin + 1);
}

std::string unquote(const std::string& text) { return strip(strip(text), "\""); }

template <typename... Values>
std::string print(const char* form, Values... values) {
  char text[400];
  std::snprintf(text, sizeof text, form, values...);
  return text;
}

// nan has a sign in C, and none in Python.
std::string general(double value, int digits) {
  return std::isnan(value) ? "nan" : print("%.*g", digits, value);
}

// The beginning of a line, with other characters than ASCII replaced.
std::string show(const std::string& text) {
  std::string line = strip(text).substr(0, SHOWN);
  for (char& each : line) {
    if (each == '\t') each = ' ';
    if (each < ' ' || each > '~') each = '?';
  }
  return line.empty() ? "nothing" : line;
}

Strings split(const std::string& row, char separator) {
  Strings cells(1);
  for (char each : row)
    if (each == separator)
      cells.emplace_back();
    else
      cells.back() += each;
  return cells;
}

Strings split_at_spaces(const std::string& row) {
  Strings cells;
  std::size_t end = 0;
  while (true) {
    const auto begin = row.find_first_not_of(SPACES, end);
    if (begin == std::string::npos) return cells;
    end = std::min(row.find_first_of(SPACES, begin), row.size());
    cells.push_back(row.substr(begin, end - begin));
  }
}

std::string read_file(const std::string& path, const std::string& name) {
  if (std::filesystem::is_directory(path)) throw Refused(name + ": Is a directory");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Refused(name + ": " + std::strerror(errno));
  return {std::istreambuf_iterator<char>(file), {}};
}

Strings split_lines(const std::string& text) {
  Strings lines(1);
  for (std::size_t i = 0; i < text.size(); i++) {
    if (text[i] != '\r' && text[i] != '\n') {
      lines.back() += text[i];
      continue;
    }
    if (text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n') i++;
    lines.emplace_back();
  }
  return lines;
}

// ---- decimals as sums of two doubles

struct Sum {
  double high, low;
};

Sum add(double a, double b) {
  const double sum = a + b, other = sum - a;
  return {sum, (a - (sum - other)) + (b - other)};
}

Sum multiply(Sum a, Sum b) {
  const double product = a.high * b.high;
  const double rest = std::fma(a.high, b.high, -product) + (a.high * b.low + a.low * b.high);
  return add(product, rest);
}

Sum divide(Sum a, Sum b) {
  const double first = a.high / b.high;
  const Sum product = multiply(b, {first, 0});
  const double rest = ((a.high - product.high) + (a.low - product.low)) / b.high;
  return add(first, rest);
}

Sum power_of_ten(int exponent) {
  Sum power{1, 0}, base{10, 0};
  for (; exponent; exponent /= 2, base = multiply(base, base))
    if (exponent % 2) power = multiply(power, base);
  return power;
}

Sum read_decimal(const std::string& text) {
  const auto e = text.find_first_of("eE");
  const std::string digits = text.substr(0, e);
  int exponent = e == std::string::npos ? 0 : std::stoi(text.substr(e + 1));
  Sum value{0, 0};
  bool point = false;
  for (char each : digits) {
    if (each == '.') point = true;
    if (each < '0' || each > '9') continue;
    const Sum ten = multiply(value, {10, 0}), next = add(ten.high, each - '0');
    value = add(next.high, next.low + ten.low);
    exponent -= point;
  }
  if (exponent < 0) value = divide(value, power_of_ten(-exponent));
  if (exponent > 0) value = multiply(value, power_of_ten(exponent));
  if (digits[0] == '-') value = {-value.high, -value.low};
  return value;
}

// ---- vectors

template <typename Numbers>
double norm(const Numbers& numbers) {
  double sum = 0;
  for (double each : numbers) sum += each * each;
  return std::sqrt(sum);
}

Quaternion conjugate(const Quaternion& q) { return {q[0], -q[1], -q[2], -q[3]}; }

Quaternion reorder(const Quaternion& q) { return {q[3], q[0], q[1], q[2]}; }

Vector radians(const Vector& v) {
  const double degree = std::acos(-1.0) / 180;
  return {v[0] * degree, v[1] * degree, v[2] * degree};
}

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// A vector of the world in the frame of the body.
Vector turn_to_body(const Quaternion& q, const Vector& v) {
  const Vector xyz = {-q[1], -q[2], -q[3]}, half = cross(xyz, v);
  const Vector twice = {2 * half[0], 2 * half[1], 2 * half[2]}, rest = cross(xyz, twice);
  Vector turned;
  for (int i = 0; i < 3; i++) turned[i] = v[i] + q[0] * twice[i] + rest[i];
  return turned;
}

// ---- the test set

struct State {
  double t, limit, limit32;
  Quaternion q, q_low;
  Vector omega, omega_low;
};

std::size_t place_of(const Strings& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) - names.begin();
}

std::vector<State> read_states(const std::string& text, const std::string& name,
                               const std::string& prefix) {
  const Strings lines = split_lines(text), names = split(lines[0], ',');
  std::vector<State> states;
  for (const std::string& line : lines) {
    if (line.rfind(name + ",", 0) != 0) continue;
    const Strings cells = split(line, ',');
    const auto number = [&](const char* column) {
      return std::stod(cells[place_of(names, column)]);
    };
    State state;
    state.t = number("t");
    state.limit = number("orientation_limit");
    state.limit32 = number("orientation_limit_float32");
    for (std::size_t i = 0; i < 4; i++) {
      const Sum sum = read_decimal(cells[place_of(names, prefix + QUATERNION[i])]);
      state.q[i] = sum.high, state.q_low[i] = sum.low;
    }
    for (std::size_t i = 0; i < 3; i++) {
      const Sum sum = read_decimal(cells[place_of(names, prefix + RATES[i])]);
      state.omega[i] = sum.high, state.omega_low[i] = sum.low;
    }
    states.push_back(state);
  }
  return states;
}

struct Problem {
  std::string name, level, what;
  double duration;
};

std::vector<Problem> read_problems(const std::string& text) {
  const Strings lines = split_lines(text), names = split(lines[0], ',');
  std::vector<Problem> problems;
  for (std::size_t i = 1; i < lines.size(); i++) {
    if (lines[i].empty()) continue;
    const Strings cells = split(lines[i], ',');
    std::string what = cells[names.size() - 1];  // the last column has commas
    for (std::size_t k = names.size(); k < cells.size(); k++) what += "," + cells[k];
    problems.push_back({cells[place_of(names, "name")], cells[place_of(names, "level")],
                        unquote(what), std::stod(cells[place_of(names, "duration")])});
  }
  return problems;
}

std::string list_problems(const std::vector<Problem>& problems) {
  std::string text = "level  name              duration  what\n";
  for (const Problem& each : problems)
    text += print("%5s  %-18s%8s  ", each.level.c_str(), each.name.c_str(),
                  (general(each.duration, 6) + " s").c_str()) +
            each.what + "\n";
  return text;
}

// ---- a trajectory

// A number, or nothing. strtod reads hexadecimal numbers, too, which the other scorers do not.
std::optional<double> read_number(const std::string& text) {
  std::string cell = unquote(text);
  std::transform(cell.begin(), cell.end(), cell.begin(), [](unsigned char c) {
    return static_cast<char>(std::tolower(c));
  });
  const std::string name = strip(cell, "+-");
  const bool is_special = name == "nan" || name == "inf" || name == "infinity";
  if (cell.empty() || (!is_special && cell.find_first_not_of("+-.e0123456789") != cell.npos))
    return std::nullopt;
  char* end = nullptr;
  const double value = std::strtod(cell.c_str(), &end);
  return *end ? std::nullopt : std::optional<double>(value);
}

using Split = std::function<Strings(const std::string&)>;

std::vector<Row> pick(const Strings& lines, const Split& split, const std::vector<std::size_t>& places,
                      const std::vector<State>& states) {
  std::vector<Row> found(states.size());
  std::vector<double> nearest(states.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 1; i < lines.size(); i++) {
    if (strip(lines[i]).empty()) continue;
    const Strings cells = split(lines[i]);
    const auto read = [&](std::size_t place) {
      if (place >= cells.size())
        throw Refused(print("line %zu must have all columns, got ", i + 1) + show(lines[i]));
      const auto value = read_number(cells[place]);
      if (!value)
        throw Refused(print("line %zu must consist of numbers, got ", i + 1) + show(lines[i]));
      return *value;
    };
    const double t = read(places[0]);
    for (std::size_t k = 0; std::isfinite(t) && k < states.size(); k++) {
      const double apart = std::abs(states[k].t - t);
      if (apart < std::abs(states[k].t - nearest[k])) nearest[k] = t;
      if (!(apart <= SAME_TIME * states[k].t)) continue;
      found[k].clear();
      for (std::size_t n = 1; n < places.size(); n++) found[k].push_back(read(places[n]));
    }
  }
  for (std::size_t k = 0; k < states.size(); k++) {
    if (!found[k].empty()) continue;
    const std::string near = std::isfinite(nearest[k])
                                 ? "the nearest is " + general(nearest[k], 12) + " s"
                                 : "there is no row";
    throw Refused("trajectory must have a state at each time, got none at " +
                  general(states[k].t, 12) + " s; " + near);
  }
  return found;
}

// Numbers of the rows at the times of the states: a quaternion, and rates if there are any.
std::vector<Row> read_trajectory(std::string text, const std::string& path,
                                 const std::vector<State>& states) {
  if (text.rfind("\xef\xbb\xbf", 0) == 0) text = text.substr(3);
  const Strings lines = split_lines(text);
  const std::string head = strip(lines[0]);
  const auto place = head.find_first_of(",") != head.npos   ? ','
                     : head.find_first_of(";") != head.npos ? ';'
                     : head.find('\t') != head.npos         ? '\t'
                                                            : ' ';
  const Split split_row = [place](const std::string& row) {
    return place == ' ' ? split_at_spaces(row) : split(row, place);
  };
  Strings header = split_row(head.rfind('#', 0) == 0 ? head.substr(1) : head);
  for (std::string& each : header) each = unquote(each);
  const auto has = [&](const Strings& columns) {
    return std::all_of(columns.begin(), columns.end(), [&](const std::string& each) {
      return place_of(header, each) < header.size();
    });
  };
  if (!has({"t"}) || !has(QUATERNION))
    throw Refused(path + " must have the columns t, w, x, y, z, got the header " + show(head));
  std::vector<std::size_t> places = {place_of(header, "t")};
  Strings names = QUATERNION;
  const bool is_world = !has(RATES) && has(WORLD_RATES);
  if (has(RATES) || is_world) {
    const Strings& rates = is_world ? WORLD_RATES : RATES;
    names.insert(names.end(), rates.begin(), rates.end());
  }
  for (const std::string& each : names) places.push_back(place_of(header, each));
  std::vector<Row> found = pick(lines, split_row, places, states);
  for (Row& row : found) {
    if (!is_world) continue;
    const double size = norm(Quaternion{row[0], row[1], row[2], row[3]});
    const Vector omega = turn_to_body({row[0] / size, row[1] / size, row[2] / size, row[3] / size},
                                      {row[4], row[5], row[6]});
    std::copy(omega.begin(), omega.end(), row.begin() + 4);
  }
  return found;
}

// ---- scores

void check(const char* name, const std::vector<Row>& rows, std::size_t begin, std::size_t end) {
  for (const Row& row : rows)
    for (std::size_t i = begin; i < end; i++)
      if (!(std::abs(row[i]) <= LARGEST_NUMBER))
        throw Refused(print("%s must be finite numbers up to 1e+100, got ", name) +
                      general(row[i], 6));
}

// Angle of the rotation that would correct an attitude, which is of either sign.
double measure_angle(const Quaternion& q, const State& exact) {
  double product = 0;
  for (int i = 0; i < 4; i++) product += q[i] * exact.q[i];
  Quaternion apart;
  for (int i = 0; i < 4; i++)
    apart[i] = ((product < 0 ? -q[i] : q[i]) - exact.q[i]) - exact.q_low[i];
  return 4 * std::asin(std::min(norm(apart) / 2, 1.0));
}

double largest(const Row& numbers) { return *std::max_element(numbers.begin(), numbers.end()); }

using Errors = std::vector<std::pair<std::string, Row>>;  // by the mistake that was mended

// The mistake without which a large error would be small, or nothing.
std::string name_mistake(const Row& errors, const Errors& others, double size) {
  const auto best = std::min_element(others.begin(), others.end(), [](auto& a, auto& b) {
    return largest(a.second) < largest(b.second);
  });
  const bool is_named =
      largest(errors) > SMALL * size && largest(best->second) < largest(errors) / MUCH;
  return is_named ? "\nlikely mistake: " + best->first : "";
}

std::string score(const std::string& name, const std::vector<Row>& rows,
                  const std::vector<State>& states) {
  check("orientations", rows, 0, 4);
  std::vector<Quaternion> attitudes;
  double worst = 1;
  for (const Row& row : rows) {
    const double size = norm(Quaternion{row[0], row[1], row[2], row[3]});
    if (std::abs(size - 1) > std::abs(worst - 1)) worst = size;
    attitudes.push_back({row[0] / size, row[1] / size, row[2] / size, row[3] / size});
  }
  if (std::abs(worst - 1) > LARGEST_NORM_ERROR)
    throw Refused("orientations must be unit quaternions, got a norm of " + general(worst, 6));

  const auto measure = [&](const std::function<Quaternion(const Quaternion&)>& mend) {
    Row errors;
    for (std::size_t k = 0; k < states.size(); k++)
      errors.push_back(measure_angle(mend(attitudes[k]), states[k]));
    return errors;
  };
  const Row angles = measure([](const Quaternion& q) { return q; });
  std::string mistakes = name_mistake(
      angles,
      {{"the quaternions have the order x, y, z, w", measure(reorder)},
       {"the quaternions are conjugate: world to body", measure(conjugate)},
       {"the quaternions are conjugate, in the order x, y, z, w",
        measure([](const Quaternion& q) { return conjugate(reorder(q)); })}},
      1.0);
  Row limits, limits32;
  double mean = 0;
  for (std::size_t k = 0; k < states.size(); k++) {
    limits.push_back(angles[k] / states[k].limit);
    limits32.push_back(angles[k] / states[k].limit32);
    mean += angles[k] / static_cast<double>(states.size());
  }
  std::string line = name + print(": attitude %.1e rad at most (mean %.1e), ", largest(angles), mean) +
                     general(largest(limits), 2) + " limits (" + general(largest(limits32), 2) +
                     " of float32)";
  if (rows[0].size() == 4) return line + mistakes;

  check("angular_velocities", rows, 4, 7);
  using Mend = std::function<Vector(const Quaternion&, const Vector&)>;
  const auto apart = [&](const Mend& mend) {
    Row errors;
    for (std::size_t k = 0; k < states.size(); k++) {
      Vector v = mend(states[k].q, {rows[k][4], rows[k][5], rows[k][6]});
      for (int i = 0; i < 3; i++) v[i] = (v[i] - states[k].omega[i]) - states[k].omega_low[i];
      errors.push_back(norm(v));
    }
    return errors;
  };
  double size = 0;
  for (const State& each : states) size = std::max(size, norm(each.omega));
  const Row rates = apart([](const Quaternion&, const Vector& v) { return v; });
  mistakes += name_mistake(
      rates,
      {{"the angular velocities are in deg/s",
        apart([](const Quaternion&, const Vector& v) { return radians(v); })},
       {"the angular velocities are in the world frame", apart(turn_to_body)},
       {"the angular velocities are in deg/s, in the world frame",
        apart([](const Quaternion& q, const Vector& v) { return turn_to_body(q, radians(v)); })}},
      size);
  return line + print("; angular velocity %.1e rad/s at most", largest(rates)) + mistakes;
}

void demand(const std::string& what, const Strings& known, const std::string& name,
            const std::string& text) {
  if (place_of(known, name) < known.size()) return;
  std::string all, got;
  for (const std::string& each : known) all += (all.empty() ? "" : ", ") + each;
  for (const std::string& each : split_at_spaces(text)) got += (got.empty() ? "" : " ") + each;
  throw Refused(what + " must be one of " + all + ", got " + got.substr(0, SHOWN));
}

std::string run(int count, char** args) {
  const auto folder = std::filesystem::absolute(args[0]).parent_path();
  const auto read_set = [&](const char* name) { return read_file((folder / name).string(), name); };
  const std::vector<Problem> problems = read_problems(read_set("problems.csv"));
  if (count == 1) return list_problems(problems);
  const std::string name = args[1];
  Strings known;
  for (const Problem& each : problems) known.push_back(each.name);
  const auto dot = std::min(name.find('.'), name.size());
  const std::string base = name.substr(0, dot), description = name.substr(std::min(dot + 1, name.size()));
  demand("problem", known, base, name);
  if (dot < name.size()) demand("description", DESCRIPTIONS, description, description);
  if (count == 2) throw Refused("trajectory must be a CSV file for " + name + ", got none");
  const std::vector<State> states = read_states(read_set("states.csv"), base, description == "turned" ? "turned_" : "");
  return score(name, read_trajectory(read_file(args[2], args[2]), args[2], states), states) + "\n";
}

}  // namespace

int main(int count, char** args) {
  if (count > 3 || (count > 1 && args[1][0] == '-')) {
    std::cerr << "usage: score [PROBLEM [TRAJECTORY]]\n";
    return 2;
  }
  try {
    std::cout << run(count, args);
  } catch (const Refused& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
