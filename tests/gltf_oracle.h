/* gltf_oracle.h: a second reader of glTF, for tests only, that shares nothing with the
 * converter's: just enough to evaluate morph targets as the specification writes them, in
 * double precision. Float accessors only, sparse or not; data URIs, files or a .glb's own
 * chunk. What it does not understand fails the test. */
#ifndef NOH_TESTS_GLTF_ORACLE_H
#define NOH_TESTS_GLTF_ORACLE_H

#include <stddef.h>
#include <stdint.h>

typedef struct oracle oracle;

oracle *oracle_read(const char *path);
void oracle_free(oracle *o);

uint32_t oracle_mesh_count(const oracle *o);
uint32_t oracle_primitive_count(const oracle *o, uint32_t mesh);
uint32_t oracle_target_count(const oracle *o, uint32_t mesh);
uint32_t oracle_vertex_count(const oracle *o, uint32_t mesh, uint32_t primitive);

/* POSITION + sum of weights[i] * target i's POSITION, for every vertex of a primitive:
 * out[vertex_count][3]. */
void oracle_positions(const oracle *o, uint32_t mesh, uint32_t primitive, const double *weights, double *out);

uint32_t oracle_node_count(const oracle *o);
/* The node's mesh, or -1; its name, or NULL where the file gives none. */
int oracle_node_mesh(const oracle *o, uint32_t node);
const char *oracle_node_name(const oracle *o, uint32_t node);
/* The node's own weights, else its mesh's, else zeros. */
void oracle_default_weights(const oracle *o, uint32_t node, double *weights);

uint32_t oracle_animation_count(const oracle *o);
const char *oracle_animation_name(const oracle *o, uint32_t animation); /* or NULL */
uint32_t oracle_channel_count(const oracle *o, uint32_t animation);
/* The node whose weights a channel moves, or -1 for any other path. */
int oracle_channel_node(const oracle *o, uint32_t animation, uint32_t channel);
double oracle_channel_end(const oracle *o, uint32_t animation, uint32_t channel);
/* Appendix C of the specification. */
void oracle_sample(const oracle *o, uint32_t animation, uint32_t channel, double time, double *weights);

#endif
