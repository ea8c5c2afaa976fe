// steady_height: a cost term in C. Vertical speed beyond what is free costs its square; with gradient.
//
// Build (any clang with a WASI sysroot does; this one comes from PyPI: pip install ziglang):
//   python -m ziglang cc -target wasm32-wasi -O3 -mexec-model=reactor -Wl,--no-entry -s \
//     steady_height.c gen/cost_term.c gen/cost_term_component_type.o -o steady_height.wasm
// `gen` is made by: wit-bindgen c ../../wit --world cost-term --out-dir gen   (wit-bindgen-cli 0.61)
#include "gen/cost_term.h"
#include <stdlib.h>
#include <string.h>

static double free_mps = 0.5;
static double dt = 1.0;

void exports_cosfly_plugin_cost_describe(exports_cosfly_plugin_cost_metadata_t *told) {
  cost_term_string_dup(&told->name, "steady_height");
  cost_term_string_dup(&told->version, "0.1.0");
  cost_term_string_dup(&told->summary, "Keeps the drone from climbing and sinking fast.");
  cost_term_string_dup(&told->params_schema,
    "{\"type\":\"object\",\"properties\":{\"free_mps\":{\"type\":\"number\",\"minimum\":0,\"maximum\":20,\"default\":0.5,"
    "\"description\":\"Vertical speed that costs nothing, m/s.\"}},\"additionalProperties\":false}");
}

// The number behind `"free_mps":` in `{"free_mps":0.5}`; the host has checked the text and filled in what was missing.
static double number_of(const char *text, size_t length) {
  const char key[] = "\"free_mps\":";
  double value = 0.0, place = 1.0;
  int behind = 0;
  for (size_t at = 0; at + sizeof key <= length; at++) {
    if (memcmp(text + at, key, sizeof key - 1) == 0) {
      for (at += sizeof key - 1; at < length; at++) {
        if (text[at] == '.') behind = 1;
        else if (text[at] < '0' || text[at] > '9') break;
        else if (behind) value += (text[at] - '0') * (place /= 10.0);
        else value = 10.0 * value + (text[at] - '0');
      }
    }
  }
  return value;
}

bool exports_cosfly_plugin_cost_configure(cost_term_string_t *params, exports_cosfly_plugin_cost_shape_t *shape,
                                          exports_cosfly_plugin_cost_error_t *error) {
  (void)error;
  free_mps = number_of((const char *)params->ptr, params->len);
  shape->support = 1;
  shape->gradients = true;
  cost_term_string_free(params);
  return true;
}

bool exports_cosfly_plugin_cost_begin(exports_cosfly_plugin_cost_run_context_t *run,
                                      exports_cosfly_plugin_cost_error_t *error) {
  (void)error;
  dt = run->dt;
  exports_cosfly_plugin_cost_run_context_free(run);
  return true;
}

bool exports_cosfly_plugin_cost_evaluate(cost_term_list_f64_t *waypoints, bool want_gradients,
                                         exports_cosfly_plugin_cost_evaluation_t *out,
                                         exports_cosfly_plugin_cost_error_t *error) {
  (void)error;
  size_t count = waypoints->len / 3;
  out->costs.ptr = calloc(count ? count : 1, sizeof(double));
  out->costs.len = count;
  out->gradients.ptr = calloc(count ? 3 * count : 1, sizeof(double));
  out->gradients.len = want_gradients ? 3 * count : 0;
  for (size_t k = 0; k + 1 < count; k++) {
    double speed = (waypoints->ptr[3 * k + 5] - waypoints->ptr[3 * k + 2]) / dt;
    double beyond = (speed < 0 ? -speed : speed) - free_mps;
    if (beyond <= 0) continue;
    out->costs.ptr[k] = beyond * beyond;
    double slope = 2.0 * beyond * (speed < 0 ? -1.0 : 1.0) / dt;
    out->gradients.ptr[3 * k + 2] -= slope;
    out->gradients.ptr[3 * k + 5] += slope;
  }
  cost_term_list_f64_free(waypoints);
  return true;
}
