/* common_face.glsl: vertex outputs of skin, eyes and teeth. It precedes common_vertex.glsl in noh_gl_shader_prefix.
 * Empty without NOH_SKIN, NOH_EYE and NOH_TEETH, or with NOH_DEPTH_ONLY. */
#ifndef NOH_DEPTH_ONLY
#if defined(NOH_SKIN) || defined(NOH_EYE) || defined(NOH_TEETH)
uniform vec4 noh_surface_values; /* noh_material.surface_values */
uniform vec3 noh_surface_more[2];
#endif

#ifdef NOH_EYE
out vec3 noh_v_gaze;
out vec4 noh_v_up;

/* The eye's gaze and up direction before skinning, in the mesh's own space, where y is up, or z if eyes look along y.
 * They turn with the normal by targets. before, after: the normal before and after targets */
void noh_gaze_vertex(vec3 before, vec3 after, out vec3 gaze, out vec4 up)
{
    vec3 turn = cross(before, after), upwards;
    float radius = length(noh_surface_values.xyz);
    gaze = radius > 0.0 ? noh_surface_values.xyz / radius : vec3(0.0, 0.0, 1.0);
    upwards = abs(gaze.y) > 0.7 ? vec3(0.0, 0.0, 1.0) : vec3(0.0, 1.0, 0.0);
    gaze = normalize(gaze + cross(turn, gaze));
    up = vec4(upwards + cross(turn, upwards), 1.0);
}

/* Both in the world, and on which side of the nose the eye is. x, y, z: rows of the world matrix */
void noh_face_vertex(vec3 rest, vec3 gaze, vec3 up, vec4 x, vec4 y, vec4 z)
{
    float radius = length(noh_surface_values.xyz) * length(vec3(x.x, y.x, z.x));
    noh_v_gaze = max(radius, 1e-6) * normalize(vec3(dot(x.xyz, gaze), dot(y.xyz, gaze), dot(z.xyz, gaze)));
    noh_v_up = vec4(dot(x.xyz, up), dot(y.xyz, up), dot(z.xyz, up), rest.x < 0.0 ? -1.0 : 1.0);
}
#endif

#if defined(NOH_SKIN) || defined(NOH_TEETH)
out float noh_v_depth; /* behind the lips, in halves of their gap; 0 outside of the mouth */

/* Half the lips' gap in the present pose, in depths of the mouth. A crowd's instances have what targets add in the
 * fraction of a row (gl_skin.c). */
float noh_half_gap()
{
#ifdef NOH_CROWD
    return noh_surface_more[1].x + 2.0 * fract(noh_crowd_row(3).w);
#else
    return noh_surface_more[1].x;
#endif
}
#endif

#ifdef NOH_TEETH
void noh_face_vertex(vec3 rest)
{
    float depth = max(1.2 - (dot(rest, noh_surface_values.xyz) + noh_surface_values.w), 0.2); /* lips are thick */
    noh_v_depth = depth / noh_half_gap();
}
#endif

#ifdef NOH_SKIN
/* The skin inside the mouth, around the teeth: what faces the middle of the hollow. normal: in the bind pose */
void noh_face_vertex(vec3 rest, vec3 normal)
{
    vec3 from = rest - noh_surface_values.yzw;
    vec2 beside = abs(from.xy) / max(noh_surface_more[0].xy, 1e-6);
    float slope = noh_surface_more[0].z;
    float high = 0.95 * beside.y + 3.0 * max(from.z * slope, 0.0); /* in front of the teeth are lips alone */
    float inside = 1.0 - smoothstep(1.0, 1.3, max(beside.x, high));
    float arch = 0.5 + 1.2 * beside.x * beside.x; /* teeth stand in an arch: cheeks lie behind the foremost, outside */
    vec3 out_of = vec3(0.3 * from.x, from.y, from.z + arch / max(slope, 1e-6)); /* rims of lips face in, too */
    inside *= 1.0 - smoothstep(-0.2, 0.1, dot(normal, normalize(out_of)));
    float depth = inside * inside * max(0.5 - from.z * slope, 0.3); /* lips are thick */
    noh_v_depth = depth / max(noh_half_gap(), 0.05); /* a dimple of a chin, which faces in a little, stays light */
}
#endif
#endif
