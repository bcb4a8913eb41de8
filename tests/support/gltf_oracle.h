/* gltf_oracle.h: a second reader of glTF, for tests only, that shares nothing with the
 * converter's: just enough to evaluate morph targets, node animations and skins as the
 * specification writes them, in double precision. It reads uncompressed accessors of every type, sparse or not; data
 * URIs, files or a .glb's own chunk; nodes without matrices. What it does not understand fails the test. */
#ifndef NOH_TESTS_SUPPORT_GLTF_ORACLE_H
#define NOH_TESTS_SUPPORT_GLTF_ORACLE_H

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

double oracle_animation_end(const oracle *o, uint32_t animation);
/* Every node's local transform at a time of an animation (-1: at rest): locals[node_count][10]
 * rotation, translation, scale. */
void oracle_pose(const oracle *o, int animation, double time, double *locals);
/* Global matrices, column-major: worlds[node_count][16]. */
void oracle_worlds(const oracle *o, const double *locals, double *worlds);

int oracle_node_skin(const oracle *o, uint32_t node); /* or -1 */
/* The positions of a primitive as the node draws it in the world: morphed, then skinned (the weights made to sum to
 * 1) or moved by the node: out[vertex_count][3]. */
void oracle_drawn(const oracle *o, uint32_t node, uint32_t primitive, const double *worlds, const double *weights,
                  double *out);

#endif
